"""What scripts/generate is made of: the command table, and one module for each kind of file."""
