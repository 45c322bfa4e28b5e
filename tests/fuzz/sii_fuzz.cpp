// Any bytes as an EEPROM: what was read can be built, and reads back the same.
#include <cstdlib>

#include "ecat/wire/sii.hpp"

using namespace taktwerk::ecat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 16384) return 0;
    auto sii = parse_sii({reinterpret_cast<const std::byte*>(data), size});
    if (sii.strings.size() > 255 || sii.has(SiiDefect::empty)) return 0;  // several string tables add up; one cannot hold more
    sii.size_code &= 0x000F;
    const auto again = parse_sii(build_sii(sii));
    sii.defects.clear();  // a building mends them
    if (again != sii) std::abort();
    return 0;
}
