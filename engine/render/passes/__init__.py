"""One file per kind of thing that is drawn; each uploads its plain data and issues few draw calls."""
