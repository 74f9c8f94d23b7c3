"""`make peers`: compares error against time of raygate and Mitsuba 3 on the same scenes."""
