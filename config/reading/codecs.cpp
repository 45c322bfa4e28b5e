#include "config/reading/codecs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "core/nearest_name.hpp"

namespace taktwerk::config {

namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
    return out;
}

/// The written value, short enough for a message.
std::string shown(const Node& node) {
    if (node.kind != Node::Kind::scalar) return std::string(describe(node));
    if (node.text.size() <= 40) return fmt::format("`{}`", node.text);
    auto cut = node.text.substr(0, 40);
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0u) == 0x80) cut.pop_back();
    if (!cut.empty() && static_cast<unsigned char>(cut.back()) >= 0x80) cut.pop_back();
    return fmt::format("`{}...`", cut);
}

void report_range(Reader& reader, const Node& node, const std::string& range) {
    reader.problem(node.at, "config.out_of_range", fmt::format("{} for `{}` is out of range", shown(node), reader.path()), "give " + range);
}

/// As people write numbers, and texts that they copy from have them, and no program reads.
struct Rewritten {
    std::string text;
    std::string_view because;  ///< empty: nothing to write otherwise
};
Rewritten rewritten(std::string_view written) {
    constexpr std::array<std::string_view, 5> dashes{"\u2212", "\u2013", "\u2014", "\u2010", "\u2011"};
    constexpr std::array<std::string_view, 5> blanks{"\u00A0", "\u202F", "\u2009", "\u2007", "\u2008"};
    const auto digit = [&](std::size_t i) { return i < written.size() && std::isdigit(static_cast<unsigned char>(written[i])) != 0; };
    Rewritten out;
    for (std::size_t i = 0; i < written.size(); ++i) {
        const auto begins_with = [&](std::string_view what) { return written.substr(i, what.size()) == what; };
        const auto dash = std::find_if(dashes.begin(), dashes.end(), begins_with),
                   blank = std::find_if(blanks.begin(), blanks.end(), begins_with);
        if (dash != dashes.end() || blank != blanks.end()) {
            out.because = dash != dashes.end() ? "a dash that only looks like a minus" : "a blank that only looks like one";
            out.text += dash != dashes.end() ? '-' : ' ';
            i += (dash != dashes.end() ? dash->size() : blank->size()) - 1;
        } else if (written[i] == ',' && i > 0 && digit(i - 1) && digit(i + 1)) {
            out.because = "a decimal comma";
            out.text += '.';
        } else if ((written[i] == ' ' || written[i] == '\'') && i > 0 && digit(i - 1) && digit(i + 1)) {
            out.because = "a mark between its thousands";
        } else {
            out.text += written[i];
        }
    }
    return out;
}
/// false: there is nothing of the kind.
bool report_rewritten(Reader& reader, const Node& node, const std::function<bool(const std::string&)>& good) {
    const auto other = rewritten(node.text);
    if (other.because.empty() || !good(other.text)) return false;
    reader.problem(
        node.at, other.because == "a decimal comma" ? "config.decimal_comma" : "config.number",
        fmt::format("{} for `{}` has {}", shown(node), reader.path(), other.because),
        fmt::format("write {}`{}`", other.because == "a decimal comma" ? "a point: " : "it with plain characters: ", other.text));
    return true;
}

std::optional<double> read_quantity(Reader& reader, const Node& node, Dimension dimension) {
    const auto unit = unit_of(dimension, reader.axis_unit);
    const auto example = example_of(dimension, reader.axis_unit);
    if (node.kind != Node::Kind::scalar) {
        report_wrong_type(reader, node, "a number with a unit", example);
        return std::nullopt;
    }
    const auto found = parse_quantity(node.text, dimension, reader.axis_unit);
    if (found.problem != QuantityProblem::none && report_rewritten(reader, node, [&](const std::string& other) {
            return parse_quantity(other, dimension, reader.axis_unit).problem == QuantityProblem::none;
        }))
        return std::nullopt;
    switch (found.problem) {
        case QuantityProblem::none: return found.value;
        case QuantityProblem::not_a_number: report_wrong_type(reader, node, "a number with a unit", example); break;
        case QuantityProblem::no_unit:
            reader.problem(node.at, "config.unit_missing", fmt::format("{} for `{}` has no unit", shown(node), reader.path()),
                           fmt::format("write it with its unit, such as `{} {}`", show_number(found.value), unit));
            break;
        case QuantityProblem::unknown_unit:
            reader.problem(node.at, "config.unit_unknown",
                           fmt::format("{} for `{}` has a unit that is not known", shown(node), reader.path()),
                           fmt::format("write it in {}, such as `{}`", unit, example));
            break;
        case QuantityProblem::wrong_unit:
            reader.problem(node.at, "config.unit_wrong",
                           fmt::format("{} for `{}` has the wrong unit: it is a quantity in {}", shown(node), reader.path(), unit),
                           fmt::format("write it in {}, such as `{}`", unit, example));
            break;
    }
    return std::nullopt;
}

/// As written by a person: 1 ms, 500 us, 60 s.
std::string show_duration(Duration d) {
    const auto ns = d.count();
    if (ns == 0) return "0 ms";
    if (ns % 1'000'000'000 == 0) return fmt::format("{} s", ns / 1'000'000'000);
    if (ns % 1'000'000 == 0) return fmt::format("{} ms", ns / 1'000'000);
    if (ns % 1'000 == 0) return fmt::format("{} us", ns / 1'000);
    return fmt::format("{} ns", ns);
}

}  // namespace

std::string wanted_text(const Shape& shape, std::string_view axis_unit) {
    switch (shape.kind) {
        case Shape::Kind::text: return "a text";
        case Shape::Kind::integer: return "a whole number";
        case Shape::Kind::number: return "a number";
        case Shape::Kind::boolean: return "true or false";
        case Shape::Kind::quantity: return fmt::format("a number with a unit, such as `{}`", example_of(shape.dimension, axis_unit));
        case Shape::Kind::choice: return "one of " + joined(shape.choices);
        case Shape::Kind::object: return "an object, such as `607Ah` or `2005h:0B`";
        case Shape::Kind::fraction: return "a ratio, such as `5/1`";
        case Shape::Kind::list: return "a list";
        case Shape::Kind::pair: return fmt::format("two values, such as `[0 {0}, 10 {0}]`", unit_of(shape.dimension, axis_unit));
        case Shape::Kind::map: return "a section of `name: ...` lines";
        case Shape::Kind::section: return "a section of `key: value` lines";
        case Shape::Kind::either: return wanted_text(*shape.alternatives.front(), axis_unit);
    }
    return "?";
}

void report_unknown_key(Reader& reader, const Entry& entry, const std::vector<std::string>& known, const OtherWords& instead) {
    if (entry.key == "<<") {  // YAML 1.1 had it, YAML 1.2 has not
        reader.problem(entry.at, "config.unknown_key", "`<<` would merge another section, and where a value came from could not be seen",
                       "write the keys out, or use an anchor for the whole section (`&name`, `*name`)");
        return;
    }
    if (!entry.key.empty() && std::isdigit(static_cast<unsigned char>(entry.key.front())) != 0) {
        reader.problem(entry.at, "config.unknown_key",
                       fmt::format("`{}` has no key `{}`: is the comma in front of it a decimal one?", reader.path(), entry.key),
                       fmt::format("write a point, as in `0.{}`", entry.key));
        return;
    }
    const auto near = entry.key.size() < 2 ? std::string{} : nearest_name(entry.key, known);  // of one letter each other one is as near
    const auto* outer = reader.outer_section_with(entry.key);
    const bool angle = entry.key.size() == 1 && std::string_view("abcABC").find(entry.key) != std::string_view::npos;
    if (angle && std::find(known.begin(), known.end(), "rx") != known.end()) {
        reader.problem(entry.at, "config.unknown_key", fmt::format("`{}` has no key `{}`", reader.path(), entry.key),
                       "turns are rx, ry, rz, about X, Y, Z; what makers call A, B, C is not the same everywhere");
        return;
    }
    const auto meant = std::find_if(instead.begin(), instead.end(), [&](const auto& word) { return word.first == entry.key; });
    reader.problem(entry.at, "config.unknown_key",
                   reader.path().empty() ? fmt::format("there is no key `{}` here", entry.key)
                                         : fmt::format("`{}` has no key `{}`", reader.path(), entry.key),
                   meant != instead.end()               ? meant->second
                   : outer != nullptr && outer->empty() ? fmt::format("`{}` stands at the top of the file: move it there", entry.key)
                   : outer != nullptr                   ? fmt::format("it is a key of `{}`: move it there", *outer)
                   : near.empty()                       ? "known keys: " + joined(known)
                                                        : fmt::format("did you mean `{}`?", near));
}

void report_missing_key(Reader& reader, const Node& section, std::string_view key, const FieldInfo& info) {
    auto doc = info.doc;
    if (!doc.empty() && doc.back() == '.') doc.pop_back();
    reader.problem(section.at, "config.missing_key",
                   reader.path().empty() ? fmt::format("the key `{}` is missing ({})", key, doc)
                                         : fmt::format("`{}` lacks its key `{}` ({})", reader.path(), key, doc),
                   fmt::format("add `{}:` with {}", key, wanted_text(info.shape, reader.axis_unit)));
}

void report_wrong_type(Reader& reader, const Node& node, std::string_view wanted, std::string_view example) {
    reader.problem(node.at, "config.wrong_type",
                   reader.path().empty() ? fmt::format("{} is not {}", shown(node), wanted)
                                         : fmt::format("{} for `{}` is not {}", shown(node), reader.path(), wanted),
                   example.empty() ? std::string("correct the value") : fmt::format("write for instance `{}`", example));
}

void report_no_section(Reader& reader, const Node& node, const std::vector<const FieldInfo*>& fields) {
    const auto needed = std::find_if(fields.begin(), fields.end(), [](const auto* f) { return f->presence == Presence::required; });
    const bool empty = node.kind == Node::Kind::null || node.text == "true";
    const std::string key = needed != fields.end() ? (*needed)->key : fields.empty() ? std::string{} : fields.front()->key;
    reader.problem(node.at, "config.wrong_type",
                   reader.path().empty() ? fmt::format("{} is not a section of `key: value` lines", shown(node))
                                         : fmt::format("{} for `{}` is not a section of `key: value` lines", shown(node), reader.path()),
                   key.empty() ? std::string("correct the value")
                               : fmt::format("write its keys indented below it, such as `{}: ...`, or in braces: {{ {}: ... }}{}", key, key,
                                             needed == fields.end() && empty ? "; `{}` where nothing of it is needed" : ""));
}

void report_no_names(Reader& reader, const Node& node) {
    reader.problem(node.at, "config.wrong_type",
                   fmt::format("{} for `{}` is not a section of `name: ...` lines", shown(node), reader.path()),
                   node.kind == Node::Kind::list ? "give each a name in place of its `-`, in a line `name: ...` or in braces: { name: ... }"
                                                 : "write lines `name: ...` indented below it, or in braces: { name: ... }");
}

bool report_key_for_name(Reader& reader, const Entry& entry, const Shape& element) {
    if (element.kind != Shape::Kind::section || !element.section || entry.value.kind == Node::Kind::map) return false;
    const auto& fields = element.section->fields;
    if (std::none_of(fields.begin(), fields.end(), [&](const auto& f) { return f.key == entry.key; })) return false;
    reader.problem(entry.at, "config.name_missing", fmt::format("`{}` has `{}` where a name comes first", reader.path(), entry.key),
                   fmt::format("write a name in front, and this in its section: `name: {{ {}: ... }}`", entry.key));
    return true;
}

bool report_decimal_comma(Reader& reader, const Entry& before, const Entry& behind) {
    const bool digits = !behind.key.empty() && std::isdigit(static_cast<unsigned char>(behind.key.front())) != 0;
    if (!digits || behind.value.kind != Node::Kind::null || before.value.kind != Node::Kind::scalar || !parse_integer(before.value.text))
        return false;
    const Reader::Scope scope(reader, before.key, before.at);
    reader.problem(before.value.at, "config.decimal_comma",
                   fmt::format("`{},{}` for `{}` has a decimal comma", before.value.text, behind.key, reader.path()),
                   fmt::format("write a point: `{}.{}`", before.value.text, behind.key));
    return true;
}

std::optional<std::int64_t> read_integer(Reader& reader, const Node& node, std::int64_t minimum, std::int64_t maximum) {
    const auto value = node.kind == Node::Kind::scalar && !node.quoted ? parse_integer(node.text) : std::nullopt;
    if (!value) {
        report_wrong_type(reader, node, "a whole number",
                          std::to_string(std::max<std::int64_t>(minimum, std::min<std::int64_t>(maximum, 1))));
        return std::nullopt;
    }
    if (*value < minimum || *value > maximum) {
        report_range(reader, node, fmt::format("{} to {}", minimum, maximum));
        return std::nullopt;
    }
    return value;
}

std::optional<std::size_t> read_choice(Reader& reader, const Node& node, const std::vector<std::string>& words) {
    if (node.kind == Node::Kind::scalar) {
        for (std::size_t i = 0; i < words.size(); ++i)
            if (words[i] == node.text) return i;
        const auto near = nearest_name(node.text, words);
        reader.problem(
            node.at, "config.unknown_word", fmt::format("{} is no value for `{}`", shown(node), reader.path()),
            near.empty() ? "choose one of " + joined(words) : fmt::format("did you mean `{}`? Possible: {}", near, joined(words)));
        return std::nullopt;
    }
    report_wrong_type(reader, node, "one of " + joined(words), words.front());
    return std::nullopt;
}

Codec<std::string> text() {
    Codec<std::string> c;
    c.shape.kind = Shape::Kind::text;
    c.read = [](Reader& reader, const Node& node, std::string& out) {
        if (node.kind != Node::Kind::scalar || node.text.empty()) {
            report_wrong_type(reader, node, "a text", {});
            return false;
        }
        out = node.text;
        return true;
    };
    c.show = [](const std::string& v) { return v; };
    return c;
}

Codec<std::string> name() {
    auto c = text();
    c.read = [any = c.read](Reader& reader, const Node& node, std::string& out) {
        if (node.kind != Node::Kind::scalar) {
            report_wrong_type(reader, node, "a name", "arm_1");
            return false;
        }
        std::string value;
        if (!any(reader, node, value)) return false;
        bool good = std::isalpha(static_cast<unsigned char>(value.front())) != 0 && value.size() <= 40;
        for (const char ch : value) good = good && (std::isalnum(static_cast<unsigned char>(ch)) != 0 || ch == '_' || ch == '-');
        if (!good) {
            reader.problem(node.at, "config.bad_name", fmt::format("{} is no name for `{}`", shown(node), reader.path()),
                           "use up to 40 letters (a-z), digits, `_` and `-`, with a letter first");
            return false;
        }
        out = value;
        return true;
    };
    return c;
}

Codec<bool> boolean() {
    Codec<bool> c;
    c.shape.kind = Shape::Kind::boolean;
    c.read = [](Reader& reader, const Node& node, bool& out) {
        if (node.kind == Node::Kind::scalar && !node.quoted && (node.text == "true" || node.text == "false")) {
            out = node.text == "true";
            return true;
        }
        report_wrong_type(reader, node, "true or false", "true");
        return false;
    };
    c.show = [](const bool& v) { return std::string(v ? "true" : "false"); };
    return c;
}

Codec<double> number(double minimum, double maximum) {
    Codec<double> c;
    c.shape.kind = Shape::Kind::number;
    constexpr auto most = std::numeric_limits<double>::max();
    if (minimum > -most) c.shape.minimum = minimum;
    if (maximum < most) c.shape.maximum = maximum;
    c.read = [minimum, maximum](Reader& reader, const Node& node, double& out) {
        const auto value = node.kind == Node::Kind::scalar && !node.quoted ? parse_number(node.text) : std::nullopt;
        if (!value) {
            const auto good = [](const std::string& other) { return parse_number(other).has_value(); };
            if (node.kind != Node::Kind::scalar || !report_rewritten(reader, node, good))
                report_wrong_type(reader, node, "a number", "1.5");
            return false;
        }
        if (*value < minimum || *value > maximum) {
            report_range(reader, node, fmt::format("{} to {}", show_number(minimum), show_number(maximum)));
            return false;
        }
        out = *value;
        return true;
    };
    c.show = [](const double& v) { return show_number(v); };
    return c;
}

Codec<double> quantity(Dimension dimension, double minimum) {
    Codec<double> c;
    c.shape.kind = Shape::Kind::quantity;
    c.shape.dimension = dimension;
    if (minimum > -std::numeric_limits<double>::max()) c.shape.minimum = minimum;
    c.read = [dimension, minimum](Reader& reader, const Node& node, double& out) {
        const auto value = read_quantity(reader, node, dimension);
        if (!value) return false;
        if (*value < minimum) {
            report_range(reader, node, fmt::format("{} {} or more", show_number(minimum), unit_of(dimension, reader.axis_unit)));
            return false;
        }
        out = *value;
        return true;
    };
    c.show = [dimension](const double& v) { return show_number(v) + (std::isinf(v) ? "" : " " + unit_of(dimension, "u")); };
    return c;
}

Codec<double> quantity_or_none(Dimension dimension) {
    auto c = quantity(dimension, 0);
    c.shape.none_allowed = true;
    c.read = [finite = c.read](Reader& reader, const Node& node, double& out) {
        if (node.kind == Node::Kind::scalar && node.text == "none") {
            out = std::numeric_limits<double>::infinity();
            return true;
        }
        return finite(reader, node, out);
    };
    return c;
}

Codec<Duration> duration(Duration minimum, Duration maximum) {
    Codec<Duration> c;
    c.shape.kind = Shape::Kind::quantity;
    c.shape.dimension = Dimension::time;
    c.read = [minimum, maximum](Reader& reader, const Node& node, Duration& out) {
        const auto seconds = read_quantity(reader, node, Dimension::time);
        if (!seconds) return false;
        const bool representable = std::abs(*seconds) < 9e9;
        const auto value = representable ? from_seconds(*seconds) : Duration::max();
        if (value < minimum || value > maximum) {
            report_range(reader, node, fmt::format("{} to {}", show_duration(minimum), show_duration(maximum)));
            return false;
        }
        out = value;
        return true;
    };
    c.show = show_duration;
    return c;
}

Codec<ObjectAddress> object_address() {
    Codec<ObjectAddress> c;
    c.shape.kind = Shape::Kind::object;
    c.read = [](Reader& reader, const Node& node, ObjectAddress& out) {
        const auto found = node.kind == Node::Kind::scalar ? parse_object(node.text) : std::nullopt;
        if (!found) {
            report_wrong_type(reader, node, "an object of the drive", "607Ah` or `2005h:0B");
            return false;
        }
        out = *found;
        return true;
    };
    return c;
}

Codec<Fraction> fraction() {
    Codec<Fraction> c;
    c.shape.kind = Shape::Kind::fraction;
    c.read = [](Reader& reader, const Node& node, Fraction& out) {
        const auto found = node.kind == Node::Kind::scalar ? parse_fraction(node.text) : std::nullopt;
        if (!found || found->numerator < 1 || found->denominator < 1) {
            report_wrong_type(reader, node, "a ratio of two whole numbers above 0", "5/1");
            return false;
        }
        out = *found;
        return true;
    };
    c.show = [](const Fraction& f) { return fmt::format("{}/{}", f.numerator, f.denominator); };
    return c;
}

Codec<std::pair<double, double>> interval(Dimension dimension) {
    Codec<std::pair<double, double>> c;
    c.shape.kind = Shape::Kind::pair;
    c.shape.dimension = dimension;
    c.read = [dimension](Reader& reader, const Node& node, std::pair<double, double>& out) {
        if (node.kind != Node::Kind::list || node.items.size() != 2) {
            const auto unit = unit_of(dimension, reader.axis_unit);
            const auto& items = node.items;
            const bool comma = items.size() > 2 && std::any_of(items.begin(), items.end(), [](const Node& item) {
                                   return item.kind == Node::Kind::scalar && parse_integer(item.text);
                               });
            if (comma)
                reader.problem(node.at, "config.decimal_comma",
                               fmt::format("`{}` has {} values, not two: is a comma in it a decimal one?", reader.path(), items.size()),
                               fmt::format("write points, such as `[0.5 {0}, 500 {0}]`", unit));
            else report_wrong_type(reader, node, "a pair of values", fmt::format("[0 {0}, 500 {0}]", unit));
            return false;
        }
        const auto low = read_quantity(reader, node.items[0], dimension), high = read_quantity(reader, node.items[1], dimension);
        if (!low || !high) return false;
        if (!(*low < *high)) {
            reader.problem(node.at, "config.out_of_range", fmt::format("the first value of `{}` is not below the second", reader.path()),
                           "put the lower value first");
            return false;
        }
        out = {*low, *high};
        return true;
    };
    return c;
}

}  // namespace taktwerk::config
