"""Files of every kind that is read, changed at random: nothing but the errors that are meant may come of it."""
