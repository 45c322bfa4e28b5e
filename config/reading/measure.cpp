#include "config/reading/measure.hpp"

#include <fmt/format.h>

#include <cmath>

#include "config/reading/unit_text.hpp"

namespace taktwerk::config {

namespace {

std::optional<Measure> read_measure(Reader& reader, const Node& node) {
    if (node.kind == Node::Kind::scalar) {
        if (const auto number = parse_number(node.text)) return Measure{*number, {}};
        if (const auto both = number_and_unit(node.text)) return Measure{both->value, both->unit};
    }
    report_wrong_type(reader, node, "a number, with a unit where it has one", "7.5 bar");
    return std::nullopt;
}

}  // namespace

Codec<Measure> measure() {
    Codec<Measure> c;
    c.shape.kind = Shape::Kind::either;
    c.shape.alternatives = {std::make_shared<const Shape>(number().shape), std::make_shared<const Shape>(text().shape)};
    c.read = [](Reader& reader, const Node& node, Measure& out) {
        const auto read = read_measure(reader, node);
        if (read) out = *read;
        return read.has_value();
    };
    return c;
}

Codec<MeasurePair> measure_pair() {
    Codec<MeasurePair> c;
    c.shape.kind = Shape::Kind::list;
    c.shape.element = std::make_shared<const Shape>(measure().shape);
    c.read = [](Reader& reader, const Node& node, MeasurePair& out) {
        if (node.kind != Node::Kind::list || node.items.size() != 2) {
            report_wrong_type(reader, node, "two values", "[0 bar, 16 bar]");
            return false;
        }
        const auto first = read_measure(reader, node.items[0]), second = read_measure(reader, node.items[1]);
        if (!first || !second) return false;
        if (first->unit != second->unit) {
            reader.problem(
                node.at, "config.unit_wrong",
                fmt::format("the two values of `{}` have different units: '{}' and '{}'", reader.path(), first->unit, second->unit),
                "write both in the same unit");
            return false;
        }
        if (first->value == second->value) {
            reader.problem(node.at, "config.out_of_range", fmt::format("the two values of `{}` are the same", reader.path()),
                           "give the two ends of a range");
            return false;
        }
        out = {first->value, second->value, first->unit};
        return true;
    };
    return c;
}

Codec<std::int16_t> milliampere() {
    auto c = text();
    Codec<std::int16_t> out;
    out.shape = c.shape;
    out.read = [](Reader& reader, const Node& node, std::int16_t& current) {
        const auto read = read_measure(reader, node);
        if (!read) return false;
        const double size = read->unit == "A" ? read->value * 1000 : read->value;
        if ((read->unit != "mA" && read->unit != "A") || !(std::abs(size) <= 32767)) {
            reader.problem(node.at, "config.unit_wrong", fmt::format("`{}` for `{}` is no current", node.text, reader.path()),
                           "write it in mA, such as `130 mA`");
            return false;
        }
        current = static_cast<std::int16_t>(std::lround(size));
        return true;
    };
    return out;
}

}  // namespace taktwerk::config
