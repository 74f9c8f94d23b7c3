"""What the lab has found, on paper: `make bench`, `make stress`, `make profile`."""
