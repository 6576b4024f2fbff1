// Linear light to the screen, applied where a surface is shaded: each MSAA sample is then already display-referred,
// so that edges against bright floor stay smooth.

// Krzysztof Narkowicz's fit of the ACES film curve, kept gentle: the pale floor must not bleach.
vec3 film(vec3 light) {
    vec3 x = light * 0.80;
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 srgb_from_linear(vec3 linear) {
    return mix(12.92 * linear, 1.055 * pow(max(linear, 0.0031308), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
}

vec3 displayed(vec3 light) {
    return srgb_from_linear(film(light));
}
