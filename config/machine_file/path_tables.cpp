#include "config/machine_file/path_tables.hpp"

#include <array>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "config/reading/codecs.hpp"
#include "config/reading/collections.hpp"
#include "config/reading/document.hpp"

namespace taktwerk::config {
namespace {

using Units = gcode::InterpreterOptions::Units;

constexpr std::array<std::string_view, gcode::coordinate_systems> systems{"G54", "G55",   "G56",   "G57",  "G58",
                                                                          "G59", "G59.1", "G59.2", "G59.3"};

template <class T>
std::vector<Field<T>> place_fields(gcode::AxisValues& (*values)(T&)) {
    const auto one = [&](const char* key, std::size_t axis, const char* doc) {
        return field_at<T>(
            key, [values, axis](T& t) -> double& { return values(t)[axis]; }, quantity(Dimension::position), doc);
    };
    return {one("x", 0, "in X"), one("y", 1, "in Y"), one("z", 2, "in Z")};
}

void in_millimetres(Reader& reader, const Node&, OffsetEntry&) { reader.axis_unit = "mm"; }

Table<OffsetEntry> tool_table() {
    Table<OffsetEntry> table{"tools.<number>",
                             "What the tool's point is away from the place that coordinates mean without a tool: G43.",
                             place_fields<OffsetEntry>([](OffsetEntry& e) -> gcode::AxisValues& { return e.zero; }),
                             {},
                             {}};
    table.before = in_millimetres;
    table.after = [](Reader& reader, const Node& node, OffsetEntry& entry) {
        unsigned number = 0;
        const char* end = entry.name.data() + entry.name.size();
        const auto [stopped, wrong] = std::from_chars(entry.name.data(), end, number);
        if (wrong == std::errc{} && stopped == end && number > 0 && number <= 99'999) return;
        reader.problem(node.at, "config.tool", "'" + entry.name + "' is no number of a tool",
                       "write a number from 1 to 99999, as T has it");
    };
    return table;
}

Table<OffsetEntry> offset_table() {
    Table<OffsetEntry> table{"offsets.<system>",
                             "The zero of a coordinate system, in machine coordinates.",
                             place_fields<OffsetEntry>([](OffsetEntry& e) -> gcode::AxisValues& { return e.zero; }),
                             {},
                             {}};
    table.before = in_millimetres;
    table.after = [](Reader& reader, const Node& node, OffsetEntry& entry) {
        for (const auto system : systems)
            if (entry.name == system) return;
        reader.problem(node.at, "config.offset", "there is no coordinate system '" + entry.name + "'",
                       "there are G54 to G59, G59.1, G59.2, G59.3");
    };
    return table;
}

}  // namespace

Table<PathEntry> path_table() {
    using P = PathEntry;
    Table<P> table{"paths.<name>", "A program in G-code, by the name that programs use: MC_PathSelect, MC_MovePath.", {}, {}, {}};
    auto& f = table.fields;
    f.push_back(required(field_at<P>(
        "file", [](P & p) -> auto& { return p.path.file; }, text(), "the program, relative to this file; read when the machine starts")));
    f.push_back(with_default(field("tables", &P::tables, text(), "file of tools, offsets and reference positions, relative to this file"),
                             "none: no tools, all zeros are the machine's"));
    f.push_back(field_at<P>(
        "unit", [](P & p) -> auto& { return p.path.options.units; }, choice<Units>({{"mm", Units::mm}, {"inch", Units::inch}}),
        "of the program's numbers until G20 or G21"));
    table.before = [](Reader&, const Node& node, P& p) { p.at = node.at; };
    return table;
}

Table<PathTablesFile> path_tables_table() {
    using F = PathTablesFile;
    Table<F> table{"", "Tools, offsets and reference positions of programs in G-code.", {}, {}, {}};
    auto& f = table.fields;
    const auto named = [](OffsetEntry& e) -> std::string& { return e.name; };
    f.push_back(field("tools", &F::named_tools, by_name(section(tool_table()), named), "by their number"));
    f.push_back(field("offsets", &F::offsets, by_name(section(offset_table()), named), "G54 and others"));
    f.push_back(group<F>("reference", "The reference position of G28, in machine coordinates.",
                         place_fields<F>([](F& file) -> gcode::AxisValues& { return file.reference; })));
    f.push_back(
        group<F>("second_reference", "That of G30.", place_fields<F>([](F& file) -> gcode::AxisValues& { return file.second_reference; })));
    table.before = [](Reader& reader, const Node&, F&) { reader.axis_unit = "mm"; };
    return table;
}

/// Some three million lines: it stands in memory as it is.
constexpr std::size_t most_program_bytes = std::size_t{64} << 20;

void complete(Reader& reader, PathEntry& entry, const std::string& beside) {
    const auto found = [&](const std::string& written) {
        const std::filesystem::path path(written);
        return (path.is_relative() ? std::filesystem::path(beside) / path : path).lexically_normal().string();
    };
    if (entry.path.file.empty()) return;  // told as missing
    auto text = read_text(found(entry.path.file), "G-code", "; it is looked up from the machine file's folder", most_program_bytes);
    if (!text) {
        reader.problem(entry.at, "config.path_file", text.error().subject + ": " + text.error().what, text.error().remedy);
        return;
    }
    entry.path.text = std::make_shared<const std::string>(std::move(*text));
    if (entry.tables.empty()) return;
    const auto path = found(entry.tables);
    if (!std::filesystem::exists(path)) {
        reader.problem(entry.at, "config.path_file", path + ": there is no such file",
                       "check the path of `tables`; it is looked up from the machine file's folder");
        return;
    }
    auto document = read_document(path);
    Reader own(path);
    own.errors() = std::move(document.errors);
    PathTablesFile file;
    if (document.root.kind != Node::Kind::null) read_table(own, document.root, path_tables_table(), file);
    std::map<unsigned long, std::string> taken;
    for (const auto& tool : file.named_tools)
        if (tool.name.find_first_not_of("0123456789") != std::string::npos) continue;  // told
        else if (const auto [other, first] = taken.emplace(std::strtoul(tool.name.c_str(), nullptr, 10), tool.name); !first)
            own.problem_in("tools." + tool.name, "config.tool", "'" + tool.name + "' and '" + other->second + "' are one number",
                           "write each number once");
    reader.errors().insert(reader.errors().end(), own.errors().begin(), own.errors().end());
    auto& options = entry.path.options;
    for (const auto& tool : file.named_tools)
        options.tools.push_back({static_cast<std::uint32_t>(std::strtoul(tool.name.c_str(), nullptr, 10)), tool.zero});
    for (const auto& offset : file.offsets)
        for (std::size_t i = 0; i < systems.size(); ++i)
            if (systems[i] == offset.name) options.offsets[i] = offset.zero;
    options.reference = file.reference;
    options.second_reference = file.second_reference;
}

}  // namespace taktwerk::config
