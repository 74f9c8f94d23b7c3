"""`make peers`: pictures by raygate and by Mitsuba 3 of the same scenes, error against time."""
