"""Files that are replaced when the new content is complete."""

import errno
import os
import secrets


class Headed:
    """The function `read` of a file object, whose first bytes are known: `head`, at most 16."""

    def __init__(self, read):
        self._read, self._parts, self.head = read, [], b""
        while len(self.head) < 16:
            part = read(16 - len(self.head))
            self._parts.append(part)
            if not isinstance(part, (bytes, bytearray, memoryview)) or not part:
                return
            self.head += part

    def __call__(self, size):
        """Returns the parts that were read already, then more."""
        return self._parts.pop(0) if self._parts else self._read(size)


def write_whole(file, data):
    """Write bytes to a temporary in the directory of a file, and rename it over the file.

    A symbolic link stays, and the file that it names is replaced. Devices and pipes receive the bytes in place. If this
    raises, the old file is unchanged.
    """
    target = os.path.realpath(os.fsdecode(file))
    exists = os.path.exists(target)
    if exists and not os.path.isfile(target):
        with open(target, "wb") as opened:
            opened.write(data)
        return
    if exists and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), file)
    part = os.path.join(os.path.dirname(target), f".raylanes.{secrets.token_hex(8)}.part")
    try:
        with open(part, "xb") as opened:
            opened.write(data)
            opened.flush()
            os.fsync(opened.fileno())
        if exists:
            os.chmod(part, os.stat(target).st_mode & 0o777)
        os.replace(part, target)
    except BaseException:
        if os.path.exists(part):
            os.unlink(part)
        raise
