#include "config/drive_file/parameter_set.hpp"

#include <fmt/format.h>

#include "axes/port/parameter_text.hpp"
#include "config/drive_file/drive_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

namespace {

struct ParameterFile {
    std::int64_t version = 0;
    std::string drive, comment;
    Node parameters;
};

Codec<Node> any_section() {
    Codec<Node> c;
    c.shape.kind = Shape::Kind::map;
    c.shape.element = std::make_shared<const Shape>(text().shape);
    c.read = [](Reader& reader, const Node& node, Node& out) {
        if (node.kind != Node::Kind::map) {
            report_wrong_type(reader, node, "a section of `parameter: value` lines", "P05.13: 250 ms");
            return false;
        }
        out = node;
        return true;
    };
    return c;
}

Table<ParameterFile> parameter_file_table() {
    using P = ParameterFile;
    return {"parameter set",
            "Parameters of one drive.",
            {version_field(&P::version), required(field("drive", &P::drive, name(), "the drive's profile")),
             field("comment", &P::comment, text(), "for people"),
             required(field("parameters", &P::parameters, any_section(), "name: value with unit"))},
            {},
            {}};
}

std::variant<ParameterSet, std::vector<Error>> from_document(const std::string& path, Document document,
                                                             const axes::DriveProfile& profile) {
    if (document.root.kind == Node::Kind::null) return std::move(document.errors);
    Reader reader(path);
    reader.errors() = std::move(document.errors);
    ParameterFile file;
    read_table(reader, document.root, parameter_file_table(), file);
    ParameterSet set{file.drive, file.comment, {}};
    if (!file.drive.empty() && file.drive != profile.name)
        reader.problem(reader.find("drive"), "drive.other_set",
                       fmt::format("these are parameters of {}, the drive is {}", file.drive, profile.name),
                       "choose the file of this drive");
    else
        for (const auto& entry : file.parameters.entries) {
            const auto refuse = [&](const Error& error) { reader.problem(entry.at, error.code, error.what, error.remedy); };
            const auto found = axes::find_parameter(profile, entry.key);
            if (!found) {
                refuse({found.error().code, "", fmt::format("{} has no parameter '{}'", profile.name, entry.key), found.error().remedy});
                continue;
            }
            const auto& parameter = **found;
            if (entry.value.kind != Node::Kind::scalar) {
                report_wrong_type(reader, entry.value, "a value", axes::value_text(parameter, parameter.value));
                continue;
            }
            if (!axes::is_setting(parameter)) {
                refuse(
                    {"drive.no_setting", "",
                     fmt::format("{} ({}) is no setting: it {}", axes::name_of(parameter), parameter.name,
                                 parameter.change == axes::ParameterChange::never ? "is read-only" : "does something when it is written"),
                     "remove the line"});
                continue;
            }
            if (const auto raw = axes::parse_value(profile, parameter, entry.value.text)) set.values.push_back({&parameter, *raw});
            else refuse({raw.error().code, "", fmt::format("{}: {}", axes::name_of(parameter), raw.error().what), raw.error().remedy});
        }
    if (!reader.errors().empty()) return std::move(reader.errors());
    return set;
}

}  // namespace

std::string text_of(const ParameterSet& set) {
    std::string out = fmt::format("version: {}\ndrive: {}\n", format_version, set.drive);
    if (!set.comment.empty()) {
        std::string quoted;
        for (const char c : set.comment) quoted += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
        out += fmt::format("comment: '{}'\n", quoted);
    }
    out += "parameters:";
    if (set.values.empty()) out += " {}";
    out += "\n";
    for (const auto& value : set.values) {
        auto key = axes::name_of(*value.parameter);
        if (key.find(':') != std::string::npos) key = "'" + key + "'";
        const auto line = fmt::format("  {}: {}", key, axes::value_text(*value.parameter, value.raw));
        out += fmt::format("{:<40} # {}\n", line, value.parameter->name);
    }
    return out;
}

std::variant<ParameterSet, std::vector<Error>> read_parameter_set(const std::string& path, const axes::DriveProfile& profile) {
    return from_document(path, read_document(path), profile);
}

std::variant<ParameterSet, std::vector<Error>> parse_parameter_set(const std::string& path, std::string_view text,
                                                                   const axes::DriveProfile& profile) {
    return from_document(path, parse_document(path, text), profile);
}

}  // namespace taktwerk::config
