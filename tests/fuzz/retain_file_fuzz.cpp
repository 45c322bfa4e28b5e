// Any bytes as a file of what is kept: nothing, or what writes and reads back the same. The check sum is put right in half of the inputs, or
// none but the whole ones would get through.
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "core/crc32.hpp"
#include "runtime/retain/kept_text.hpp"
#include "runtime/retain/value_type.hpp"

using namespace taktwerk;
using namespace taktwerk::runtime;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] & 1) text += fmt::format("crc {:08x}\n", crc32(std::as_bytes(std::span(text.data(), text.size()))));
    const auto kept = kept_of(text);
    if (!kept) return 0;
    for (const auto& axis : kept->axes)
        if (axis.name.empty() || !std::isfinite(axis.position.shift) || !std::isfinite(axis.gearing.feed)) std::abort();
    for (const auto& value : kept->values)
        if (value.name.empty() || size_of(value.type) == 0 || (size_of(value.type) < 8 && value.bits >> (8 * size_of(value.type)) != 0))
            std::abort();
    const auto written = text_of(*kept);
    const auto again = kept_of(written);
    if (!again || text_of(*again) != written) std::abort();
    return 0;
}
