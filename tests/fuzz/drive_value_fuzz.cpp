// Any bytes as NAME=VALUE for a drive, and as the bytes that its parameter answers with: what is taken is in the manual's range, fits its
// width and reads back; the same for objects by their CoE type.
#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "axes/port/parameter_text.hpp"
#include "config/drive_file/drive_loader.hpp"
#include "config/reading/quantity.hpp"
#include "ecat/diagnosis/object_value.hpp"

using namespace taktwerk;

namespace {

std::shared_ptr<const axes::DriveProfile> drive(const char* file) {
    const auto loaded = config::load_drive(std::string(TAKTWERK_SOURCE_DIR "/config/drives/") + file);
    if (!std::holds_alternative<config::LoadedDrive>(loaded)) std::abort();
    return std::get<config::LoadedDrive>(loaded).profile;
}

void of_a_drive(const axes::DriveProfile& profile, std::string_view name, std::string_view value) {
    const auto found = axes::find_parameter(profile, name);
    if (!found) {
        if (found.error().what.empty()) std::abort();
        return;
    }
    const auto& parameter = **found;
    const auto raw = axes::parse_value(parameter, value);
    if (!raw) {
        if (raw.error().what.empty()) std::abort();
    } else {
        const auto carried = axes::from_bytes(parameter, axes::to_bytes(parameter, *raw));
        if (!carried || *carried != *raw) std::abort();
        const auto again = axes::parse_value(parameter, axes::value_text(parameter, *raw));
        if (!again || *again != *raw) std::abort();
    }
    const auto answer = std::as_bytes(std::span(value.data(), value.size()));
    if (const auto read = axes::from_bytes(parameter, answer)) (void)axes::value_text(parameter, *read);
}

void of_an_object(std::string_view type, std::string_view value) {
    const auto number = ecat::type_number(type);
    if (!number) return;
    (void)ecat::value_text(*number, std::as_bytes(std::span(value.data(), value.size())));
    const auto bytes = ecat::parse_value(*number, value);
    if (!bytes && bytes.error().what.empty()) std::abort();
    if (bytes) (void)ecat::value_text(*number, *bytes);
}

void of_a_file(std::string_view text) {
    using config::Dimension;
    for (const auto dimension : {Dimension::time, Dimension::frequency, Dimension::velocity, Dimension::torque, Dimension::ratio_ppm})
        (void)config::parse_quantity(text, dimension, "mm");
    (void)config::parse_fraction(text);
    if (const auto number = config::parse_number(text))
        if (config::parse_number(config::show_number(*number)) != number) std::abort();
    (void)config::parse_integer(text);
    if (const auto object = config::parse_object(text)) {
        auto again = config::parse_object(config::show_object(object->index, object->sub));
        if (!again || again->index != object->index || again->sub != object->sub) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto serial = drive("xp200.yaml"), bus = drive("tsvm-d6.yaml");
    const std::string_view text{reinterpret_cast<const char*>(data), size};
    const auto equals = std::min(text.find('='), text.size());
    const auto name = text.substr(0, equals), value = text.substr(std::min(equals + 1, text.size()));
    of_a_drive(*serial, name, value);
    of_a_drive(*bus, name, value);
    of_an_object(name, value);
    of_a_file(value);
    return 0;
}
