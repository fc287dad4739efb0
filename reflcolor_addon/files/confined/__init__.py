"""Native code that reads files of strangers, in a process of its own with limits and without a way to the network."""
