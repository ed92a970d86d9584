"""Whether LCM can work on this machine, the private network where it cannot, and the key of the bus."""

import os
import shlex
import socket

from .messages import say
from .programs import ROOT, program

LCM_GROUP = ("239.255.76.67", 7667)  # LCM's default
RECEIVE_BUFFER = 4194304  # bytes
SMALL_RECEIVE_BUFFER = 2097152
PRIVATE = "KINTSUGI_PRIVATE_BUS"  # in the environment of what runs in a private network
OWN_USERS = "user"  # its value where that is in a namespace of users, too: private_bus makes one unless root calls it
BUS_KEY = "KINTSUGI_BUS_KEY"  # in the environment of what signs
RMEM_MAX = "/proc/sys/net/core/rmem_max"
CURE_FOR_ROUTE = "sudo ip link set lo up && sudo ip route add 224.0.0.0/4 dev lo"


def choose_network(private, command):
    """Returns if LCM can work here. If `private`, or if there is no route for multicast, replaces this process by
    `command` in a private network."""
    if private:
        enter_private_network(command)
    elif not os.environ.get("LCM_DEFAULT_URL") and not has_multicast_route():
        say("this machine has no route for multicast, so LCM cannot work on it. To add one:")
        say("  " + CURE_FOR_ROUTE)
        say("until then: running in a private network")
        enter_private_network(command)
    note_receive_buffer()


def tell_how_to_ask():
    """Where this is a private network, which is entered from outside through a process in it."""
    if not os.environ.get(PRIVATE):
        return
    user = " --user --preserve-credentials" if os.environ[PRIVATE] == OWN_USERS else ""
    question = shlex.join([program("status"), "--once", *bus_key_option()])
    say(f"in a private network. To ask the run from another terminal: nsenter --target {os.getpid()}{user} --net "
        f"{question} (kintsugi-query and others alike)")


def use_bus_key(file="", folder=None):
    """For all that is started from here, in whichever folder: they read the file. `folder`: for a relative path; None:
    the current one. Without a file the one in the environment remains."""
    if not file:
        file, folder = os.environ.get(BUS_KEY), None
    if file:
        os.environ[BUS_KEY] = os.path.abspath(os.path.join(folder or os.curdir, file))


def bus_key_option():
    """The key of this run as an option, for what has another environment; [] without a key."""
    return [f"--bus-key={os.environ[BUS_KEY]}"] if os.environ.get(BUS_KEY) else []


def enter_private_network(command):
    """Replaces this process by `command` there, unless the environment says that it is there already."""
    if os.environ.get(PRIVATE):
        return
    os.environ[PRIVATE] = "1" if os.geteuid() == 0 else OWN_USERS
    private_bus = os.path.join(ROOT, "scripts", "private_bus")
    os.execv(private_bus, [private_bus, *command])


def has_multicast_route():
    """connect() of a UDP socket sends nothing; it fails where the kernel knows no route."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(LCM_GROUP)
        except OSError:
            return False
    return True


def note_receive_buffer():
    """A small receive buffer only costs time: what is lost is sent again. In a private network some
    kernels do not show the limit."""
    try:
        with open(RMEM_MAX, encoding="ascii") as file:
            size = int(file.read())
    except (OSError, ValueError):
        return
    if size < SMALL_RECEIVE_BUFFER:
        say(f"note: a receive buffer has at most {size} bytes here. What is lost is sent again, which takes time."
            " To enlarge it:")
        say(f"  sudo sysctl -w net.core.rmem_max={RECEIVE_BUFFER}")
