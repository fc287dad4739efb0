"""Native code that reads untrusted files, in a separate process with limits and without network access."""
