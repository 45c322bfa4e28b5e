#include "axes/drives/cia402/drive_on_bus.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/drives/cia402/words.hpp"

namespace taktwerk::axes::cia402 {

std::string DriveOnBus::subject() const { return fmt::format("slave '{}' axis {}", slave().name, axis_ + 1); }

std::uint16_t DriveOnBus::object(std::uint16_t base) const noexcept { return object_of_axis(base, offset_); }

bool DriveOnBus::find_output(MappedOutput& output, std::uint16_t base, std::uint8_t sub, bool is_signed) const {
    const auto index = object(base);
    output = {};
    if (!bus_.maps_output(slave_, index, sub)) return false;
    const auto found = bus_.output(slave_, index, sub);
    if (!found) return false;
    output.signal = *found;
    output.signal.is_signed = is_signed;
    output.set_type_range();
    if (const auto& device = slave().device)
        for (const auto& entry : device->objects) {
            if (entry.index != index || entry.sub != sub) continue;
            if (entry.minimum) output.low = std::max(output.low, *entry.minimum);
            if (entry.maximum) output.high = std::min(output.high, *entry.maximum);
        }
    return true;
}

bool DriveOnBus::find_input(Signal& signal, std::uint16_t base, std::uint8_t sub, bool is_signed) const {
    const auto index = object(base);
    signal = {};
    if (!bus_.maps_input(slave_, index, sub)) return false;
    const auto found = bus_.input(slave_, index, sub);
    if (!found) return false;
    signal = *found;
    signal.is_signed = is_signed;
    return true;
}

}  // namespace taktwerk::axes::cia402
