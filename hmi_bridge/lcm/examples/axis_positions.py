#!/usr/bin/env python3
# The same in Python, without the lcm module, which Debian does not package: LCM's small messages are one datagram each. First, in this folder:
#   lcm-gen -p --ppath . /usr/share/taktwerk/lcm/*.lcm
import socket, struct, sys, time
from taktwerk_lcm.axis_state_v1_t import axis_state_v1_t

GROUP, PORT, SMALL = "239.255.76.67", 7667, 0x4C433032  # "LC02": magic, sequence, channel, NUL, message
channel = ("TAKTWERK_%s_AXIS_STATE" % (sys.argv[1] if len(sys.argv) > 1 else "DEMO")).encode()
listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
listener.bind((GROUP, PORT))
listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, struct.pack("4s4s", socket.inet_aton(GROUP), socket.inet_aton("0.0.0.0")))
listener.settimeout(0.05)
axes, heard, shown = {}, 0.0, time.monotonic()
while True:
    try:
        packet = listener.recv(65536)
        name, _, message = packet[8:].partition(b"\0")
        if struct.unpack(">I", packet[:4])[0] == SMALL and name == channel:
            axis = axis_state_v1_t.decode(message)  # raises ValueError where the type is another
            axes[axis.name], heard = axis, time.monotonic()
    except (socket.timeout, ValueError, struct.error):
        pass
    if time.monotonic() - shown < 0.25:
        continue
    shown = time.monotonic()
    print(("STALE " if shown - heard > 0.5 else "") + "  ".join("%s=%.6f %s" % (n, a.actual_position, a.unit) for n, a in sorted(axes.items())), flush=True)
