"""Files and names that a power cut does not take: a name is on the disk when its folder has been synced."""

import os


def sync_file(path):
    sync(path, os.O_RDONLY)


def sync_folder(path):
    sync(path, os.O_RDONLY | os.O_DIRECTORY)


def sync(path, flags):
    descriptor = os.open(path, flags)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
