#include "fb_library/block_reference.hpp"

#include <map>
#include <string_view>

#include "fb_library/block_types.hpp"

namespace taktwerk::fb {
namespace {

std::string_view direction_name(PinDirection direction) {
    switch (direction) {
        case PinDirection::in: return "in";
        case PinDirection::out: return "out";
        case PinDirection::in_out: return "in/out";
    }
    return "";
}

/// A bar would end the table's cell.
void append_cell(std::string& page, std::string_view text) {
    page += ' ';
    for (const char c : text) {
        if (c == '|') page += '\\';
        page += c;
    }
    page += " |";
}

void append_block(std::string& page, const BlockType& type) {
    page += "\n### ";
    page += type.name;
    page += "\n\n";
    page += type.summary;
    page += "\n\n| pin | | type | unit | |\n|---|---|---|---|---|\n";
    for (const Pin& pin : type.pins) {
        page += '|';
        for (const auto cell : {pin.name, direction_name(pin.direction), pin.type.name, pin.unit, pin.doc}) append_cell(page, cell);
        page += '\n';
    }
}

}  // namespace

std::string block_reference_markdown() {
    std::string page =
        "# Function blocks\n\n"
        "Generated from the pin tables. Units: u is the axis' configured unit (mm, deg, ...). TIME is 64 bit nanoseconds.\n"
        "Pins keep their values between calls; a block acts only when called.\n";

    page += "\n## IEC 61131-3\n";
    for (const BlockType& type : iec_block_types()) append_block(page, type);
    page += "\n## PLCopen motion\n";
    for (const BlockType& type : motion_block_types()) append_block(page, type);
    page += "\n## PLCopen homing\n";
    for (const BlockType& type : homing_block_types()) append_block(page, type);
    page += "\n## PLCopen groups\n";
    for (const BlockType& type : group_block_types()) append_block(page, type);

    page += "\n## Stored paths\n";
    for (const BlockType& type : path_block_types()) append_block(page, type);

    page += "\n## Fieldbus\n";
    for (const BlockType& type : fieldbus_block_types()) append_block(page, type);

    std::map<std::string_view, std::span<const std::string_view>> enumerations;
    for (const BlockType& type : all_block_types())
        for (const Pin& pin : type.pins)
            if (pin.type.kind == PinKind::ENUM) enumerations[pin.type.name] = pin.type.values;
    page += "\n## Enumerations\n";
    for (const auto& [name, values] : enumerations) {
        page += "\n### ";
        page += name;
        page += "\n\n";
        for (std::size_t i = 0; i < values.size(); ++i)
            page += std::to_string(i) + " " + std::string{values[i]} + (i + 1 < values.size() ? ", " : "\n");
    }
    return page;
}

}  // namespace taktwerk::fb
