"""Writes files that are either the old one or the whole new one, as the program itself does."""

import fcntl
import os
import re
import secrets

DRAFT = ".part-"
LONGEST_STEM = 200  # characters of a file's name that are in its draft's


def lock(file):
    """The process that writes a draft holds a lock on it; the system releases the lock when the process ends."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def remove_abandoned_drafts(folder, stem):
    for name in os.listdir(folder):
        if re.fullmatch(re.escape(stem) + "[0-9a-f]{8}", name):
            with open(folder / name, "rb") as draft:
                if lock(draft):
                    os.unlink(folder / name)


def write_whole(path, content):
    """Writes bytes to a draft in the folder of the file, then renames it. A link stays one; what is no plain file is
    written to as it is. Raises OSError, with the file's name, where it cannot be written."""
    path = path.resolve()
    if path.exists() and not path.is_file():
        path.write_bytes(content)
        return
    stem = path.name[:LONGEST_STEM] + DRAFT
    draft = path.with_name(stem + secrets.token_hex(4))
    try:
        remove_abandoned_drafts(path.parent, stem)
        with open(draft, "xb") as file:
            lock(file)
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
            if path.exists():
                os.fchmod(file.fileno(), path.stat().st_mode & 0o7777)
            os.replace(draft, path)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        draft.unlink(missing_ok=True)
