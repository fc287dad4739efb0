"""Files in and out: readers and writers of scans, images, whole files, memory."""
