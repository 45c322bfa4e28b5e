#include "config/reference/reference.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "config/device_file/device_file_tables.hpp"
#include "config/drive_file/drive_tables.hpp"
#include "config/machine_file/machine_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

using Kind = Shape::Kind;

// --- JSON -----------------------------------------------------------------------------------------------------------------

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

std::string whole(double value) { return fmt::format("{:.0f}", value); }

/// Accepts what the loader accepts, roughly: an editor's help, not a second judge.
std::string quantity_pattern(const Shape& shape) {
    static constexpr std::string_view number = "[-+]?[0-9]*\\\\.?[0-9]+([eE][-+]?[0-9]+)?";
    std::string_view unit;
    switch (shape.dimension) {
        case Dimension::time: unit = "(ns|us|ms|s|min)"; break;
        case Dimension::frequency: unit = "(Hz|kHz|MHz)"; break;
        case Dimension::angle: unit = "(deg|rad|rev)"; break;
        case Dimension::position: unit = "(um|mm|cm|m|deg|rad|rev)"; break;
        case Dimension::velocity: unit = "((um|mm|cm|m|deg|rad|rev)/(s|min)|rpm)"; break;
        case Dimension::acceleration: unit = "(um|mm|cm|m|deg|rad|rev)/s\\\\^?(2|²)"; break;
        case Dimension::jerk: unit = "(um|mm|cm|m|deg|rad|rev)/s\\\\^?(3|³)"; break;
        case Dimension::torque: unit = "m?Nm"; break;
        case Dimension::inertia: unit = "kg ?c?m\\\\^?(2|²)"; break;
        case Dimension::mass: unit = "k?g"; break;
        case Dimension::friction: unit = "Nm ?s(/rad)?"; break;
        case Dimension::ratio_ppm: unit = "ppm"; break;
        case Dimension::voltage: unit = "m?V"; break;
        case Dimension::cycles: unit = "(cycles?|ns|us|ms|s)"; break;
    }
    return fmt::format("^{} *{}{}$", number, unit, shape.none_allowed ? "|^none" : "");
}

std::string schema_of(const Shape& shape, int indent);

std::string schema_of(const SectionInfo& section, int indent) {
    const std::string pad(static_cast<std::size_t>(indent), ' ');
    std::string properties, required;
    for (const auto& field : section.fields) {
        properties += fmt::format("{}{}    {}: {{\"description\": {}, {}}}", properties.empty() ? "" : ",\n", pad, quoted(field.key),
                                  quoted(field.doc), schema_of(field.shape, indent + 4));
        if (field.presence == Presence::required) required += (required.empty() ? "" : ", ") + quoted(field.key);
    }
    return fmt::format("\"type\": \"object\", \"additionalProperties\": false, {}\"properties\": {{\n{}\n{}}}",
                       required.empty() ? "" : fmt::format("\"required\": [{}], ", required), properties, pad);
}

/// The members of a schema object, without its braces.
std::string schema_of(const Shape& shape, int indent) {
    switch (shape.kind) {
        case Kind::text: return R"("type": "string", "minLength": 1)";
        case Kind::integer:
            if (shape.minimum && shape.maximum && std::abs(*shape.minimum) <= 4294967296.0 && std::abs(*shape.maximum) <= 4294967296.0)
                return fmt::format(
                    R"("anyOf": [{{"type": "integer", "minimum": {}, "maximum": {}}}, {{"type": "string", "pattern": "^[-+]?[0-9A-Fa-f]+h$"}}])",
                    whole(*shape.minimum), whole(*shape.maximum));
            return R"("type": "integer")";
        case Kind::number: {
            std::string out = R"("type": "number")";
            if (shape.minimum) out += fmt::format(", \"minimum\": {}", show_number(*shape.minimum));
            if (shape.maximum) out += fmt::format(", \"maximum\": {}", show_number(*shape.maximum));
            return out;
        }
        case Kind::boolean: return R"("type": "boolean")";
        case Kind::quantity: return fmt::format(R"("type": "string", "pattern": "{}")", quantity_pattern(shape));
        case Kind::choice: {
            std::string words;
            for (const auto& word : shape.choices) words += (words.empty() ? "" : ", ") + quoted(word);
            return fmt::format("\"enum\": [{}]", words);
        }
        case Kind::object:
            return R"("type": "string", "pattern": "^([0-9A-Fa-f]{1,4}[hH]|0[xX][0-9A-Fa-f]{1,4})(:[0-9A-Fa-fxX]+)?( */ *[0-9]+)?$")";
        case Kind::fraction: return R"("type": ["string", "integer"], "pattern": "^[0-9]+ *[/:] *[0-9]+$")";
        case Kind::list: return fmt::format("\"type\": \"array\", \"items\": {{{}}}", schema_of(*shape.element, indent));
        case Kind::pair:
            return fmt::format(R"("type": "array", "minItems": 2, "maxItems": 2, "items": {{"type": "string", "pattern": "{}"}})",
                               quantity_pattern(shape));
        case Kind::map: return fmt::format("\"type\": \"object\", \"additionalProperties\": {{{}}}", schema_of(*shape.element, indent));
        case Kind::section: return schema_of(*shape.section, indent);
        case Kind::either: {
            std::string all;
            for (const auto& one : shape.alternatives) all += (all.empty() ? "" : ", ") + fmt::format("{{{}}}", schema_of(*one, indent));
            return fmt::format("\"anyOf\": [{}]", all);
        }
    }
    return {};
}

std::string schema(const SectionInfo& section, std::string_view name) {
    return fmt::format("{{\n\"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n\"title\": {}, \"description\": {},\n{}\n}}\n",
                       quoted(name), quoted(section.doc), schema_of(section, 0));
}

// --- Markdown ---------------------------------------------------------------------------------------------------------------

std::string value_text(const Shape& shape) {
    switch (shape.kind) {
        case Kind::text: return "text";
        case Kind::integer:
            if (shape.minimum && shape.maximum && std::abs(*shape.minimum) <= 4294967296.0 && std::abs(*shape.maximum) <= 4294967296.0)
                return *shape.minimum == *shape.maximum ? whole(*shape.minimum)
                                                        : fmt::format("{} .. {}", whole(*shape.minimum), whole(*shape.maximum));
            return "whole number";
        case Kind::number: return "number";
        case Kind::boolean: return "true, false";
        case Kind::quantity: return fmt::format("in {}{}", unit_of(shape.dimension, "u"), shape.none_allowed ? ", or `none`" : "");
        case Kind::choice: {
            std::string words;
            for (const auto& word : shape.choices) words += (words.empty() ? "`" : ", `") + word + "`";
            return words;
        }
        case Kind::object: return "object, `607Ah`";
        case Kind::fraction: return "ratio, `5/1`";
        case Kind::list: return shape.element->kind == Kind::section ? "list of sections" : "list: " + value_text(*shape.element);
        case Kind::pair: return fmt::format("[low, high] in {}", unit_of(shape.dimension, "u"));
        case Kind::map: return shape.element->kind == Kind::section ? "sections by name" : "by name: " + value_text(*shape.element);
        case Kind::section: return "section";
        case Kind::either: {
            std::string all;
            for (const auto& one : shape.alternatives) all += (all.empty() ? "" : ", ") + value_text(*one);
            return all;
        }
    }
    return {};
}

class Page {
public:
    void section(const SectionInfo& info, const std::string& path, int level) {
        text += fmt::format("{} {}\n\n{}\n\n| key | value | default | meaning |\n|---|---|---|---|\n",
                            std::string(static_cast<std::size_t>(level), '#'), path.empty() ? info.title : "`" + path + "`", info.doc);
        for (const auto& field : info.fields)
            text += fmt::format("| `{}` | {} | {} | {} |\n", field.key, cell(value_text(field.shape)),
                                field.presence == Presence::required ? "**required**" : cell(field.default_text), cell(field.doc));
        text += "\n";
        for (const auto& field : info.fields) inner(field.shape, path.empty() ? field.key : path + "." + field.key);
    }
    std::string text;

private:
    static std::string cell(const std::string& text) {
        std::string out;
        for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
        return out;
    }
    void inner(const Shape& shape, const std::string& path) {
        if (shape.kind == Kind::section) section(*shape.section, path, 3);
        else if (shape.kind == Kind::list) inner(*shape.element, path + "[]");
        else if (shape.kind == Kind::map) inner(*shape.element, path + ".<name>");
    }
};

}  // namespace

std::string machine_schema() { return schema(*machine_table().info(), "Taktwerk machine"); }
std::string drive_schema() { return schema(*drive_table().info(), "Taktwerk drive type"); }

std::string device_schema() { return schema(*device_file_table().info(), "Taktwerk device type"); }

std::string reference_page() {
    Page page;
    page.text =
        "# Configuration\n\n"
        "Made from the field tables in `config/`; do not edit. `taktwerk check FILE` reports all problems of a file at once, each as\n"
        "`file:line:col: what. what to do`. Editors complete keys with `config/schema/*.schema.json`. Start from "
        "`config/machines/minimal.yaml`;\n"
        "`config/machines/demo.yaml` shows nearly everything, with comments.\n\n"
        "Values with a dimension carry their unit: `1 ms`, `100 mm/s`, `2000 mm/s2`, `360 deg`, `0.5 Nm`, `2e-4 kg m2`, `50 Hz`. A bare "
        "number there is an\n"
        "error. **u** is the unit of the axis; its quantities may be written in any unit of the same family: um, mm, cm, m, or deg, rad, "
        "rev\n"
        "(also `rpm`, and `/min` for velocities). Times: ns, us, ms, s, min. Whole numbers may be written as `0x1600` or `1600h`, objects "
        "as manuals\n"
        "print them, `2005h:0B` with the sub-index in hexadecimal, or `0x2005:11` with it in decimal. YAML anchors and aliases work.\n\n";
    page.section(*machine_table().info(), "", 2);
    page.section(*drive_table().info(), "", 2);
    page.section(*serial_drive_table().info(), "", 2);
    page.section(*alarm_table().info(), "", 2);
    page.section(*device_file_table().info(), "", 2);
    while (page.text.size() > 1 && page.text[page.text.size() - 2] == '\n') page.text.pop_back();
    return page.text;
}

}  // namespace taktwerk::config
