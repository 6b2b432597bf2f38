"""Files of the report: each appears, or replaces an older file, only when it is complete."""
import errno
import os
import pathlib
import tempfile


def mode_of(file):
    """The permissions of the file, or those of new files."""
    if file.exists():
        return file.stat().st_mode & 0o777
    masked = os.umask(0)
    os.umask(masked)
    return 0o666 & ~masked


def write_whole(file, content):
    """Writes text or bytes to a temporary in the directory of the file, and renames it over the file.

    A symbolic link stays, and the file that it names is replaced. Raises OSError if the file exists and is not a plain
    file or not writable, or if it cannot be written: the old file is then unchanged.
    """
    target = pathlib.Path(os.path.realpath(file))
    if target.exists() and not (target.is_file() and os.access(target, os.W_OK)):
        raise OSError(errno.EACCES, 'cannot be written: it is not a plain file, or not writable', str(file))
    data = content.encode() if isinstance(content, str) else content
    number, part = tempfile.mkstemp(suffix='.part', prefix='.raylanes.', dir=target.parent)
    try:
        with os.fdopen(number, 'wb') as out:
            out.write(data)
            out.flush()
            os.fchmod(number, mode_of(target))
            os.fsync(number)
        os.replace(part, target)
    except BaseException:
        os.unlink(part)
        raise
