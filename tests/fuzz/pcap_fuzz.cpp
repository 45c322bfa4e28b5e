// Any bytes as a capture file: packets lie inside the file, and each is read as a frame.
#include <cstdlib>

#include "ecat/wire/frame.hpp"
#include "tests/ecat/wire/pcapng.hpp"

using namespace taktwerk::ecat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto file = std::span{reinterpret_cast<const std::byte*>(data), size};
    std::size_t carried = 0;
    for (const auto packet : test::parse_pcapng(file)) {
        if (!packet.empty() && (packet.data() < file.data() || packet.data() + packet.size() > file.data() + file.size())) std::abort();
        carried += packet.size();
        FrameReader reader{packet};
        while (const auto datagram = reader.next())
            if (datagram->data.size() > packet.size()) std::abort();
    }
    if (carried > size) std::abort();
    return 0;
}
