"""What is wrong with a file that should be whole."""

from ...messages import Message


class Fault(Exception):
    """A file is not whole; takes what `Message` takes."""

    def __init__(self, template, /, **values):
        self.message = Message(template, **values)
        super().__init__(self.message)


def exactly(file, count):
    """Read that many bytes; Fault where there are fewer."""
    data = file.read(count)
    if len(data) != count:
        raise Fault("it is cut short")
    return data


def require_end(at, size):
    """Fault where a file of ``size`` bytes does not end ``at`` this byte, which its own structure tells."""
    if at > size:
        raise Fault("it is cut short: {found:,} of {expected:,} bytes", found=size, expected=at)
    if at < size:
        raise Fault("{count:,} bytes follow its end", count=size - at)
