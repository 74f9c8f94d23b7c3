"""`make bench`: run time against error, from the adder to the picture."""
