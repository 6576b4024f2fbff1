"""What a game is built on, and knows nothing of threats: worlds of columns and their clock (`core`), mathematics
(`maths`), motion capture (`clips`), one skeleton and its masses (`body`), MuJoCo (`physics`), OpenGL (`render`).
"""
