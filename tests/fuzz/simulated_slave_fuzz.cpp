// Any frames and mailbox messages at a simulated slave: it stays within its memory and its state machine, whatever a master sends.
// Input: records of [kind, size, bytes]: kind 0 is a whole frame, kind 1 a message into the mailbox of a drive in PREOP.
#include <algorithm>
#include <cstdlib>

#include "tests/ecat/sim/bus_probe.hpp"

using namespace taktwerk;
using namespace taktwerk::ecat;
using namespace taktwerk::ecat::sim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 1024) return -1;  // longer is no deeper, only slower
    BusProbe bus;
    SimSlave& drive = bus.add_drive();
    bus.to_preop(0);
    for (std::size_t at = 0; at + 2 <= size;) {
        const std::uint8_t kind = data[at];
        const std::size_t length = std::min<std::size_t>(data[at + 1], size - at - 2);
        const auto bytes = std::span{reinterpret_cast<const std::byte*>(data + at + 2), length};
        at += 2 + length;
        if (kind % 2 == 0) {
            Bytes frame(std::max<std::size_t>(length, 60));
            std::copy(bytes.begin(), bytes.end(), frame.begin());
            (void)bus.network.process(frame, bus.now);
        } else {
            Bytes message(0x80);
            std::copy_n(bytes.begin(), std::min(bytes.size(), message.size()), message.begin());
            bus.write(0, 0x1000, message);
            bus.wait(2ms);
            bus.read(0, 0x1400, 0x80);
        }
        const auto state = static_cast<unsigned>(drive.state());
        if (state != 1 && state != 2 && state != 3 && state != 4 && state != 8) std::abort();
    }
    return 0;
}
