"""One module for each word of `brace`, each with `register(subparsers)` and `run(args)`."""
