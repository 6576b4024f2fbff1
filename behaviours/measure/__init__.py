"""What a run was like: an observer keeps what was shown, measures are made from it; the report of `brace react`."""
