"""What a user starts: the `brace` command (`cli`), the figures, the window's play, and short programs to read."""
