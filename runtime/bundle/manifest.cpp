#include "runtime/bundle/manifest.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <limits>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runtime/bundle/container.hpp"
#include "runtime/json/json_fields.hpp"

namespace taktwerk::runtime {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 6> kinds{"machine", "drive", "device", "program", "cam", "image"};

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool digit(char c) { return c >= '0' && c <= '9'; }
bool all_hexadecimal(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return digit(c) || (c >= 'a' && c <= 'f'); });
}
bool printable(std::string_view text) {
    return text.size() <= 60 && std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7f; });
}

/// Seconds of "2026-11-26T05:12:00Z"; -1: it is no such time.
std::int64_t seconds_of(std::string_view text) {
    using namespace std::chrono;
    constexpr std::string_view form = "dddd-dd-ddTdd:dd:ddZ";
    if (text.size() != form.size()) return -1;
    for (std::size_t i = 0; i < form.size(); ++i)
        if (form[i] == 'd' ? !digit(text[i]) : form[i] != text[i]) return -1;
    const auto number = [&](std::size_t at, std::size_t count) {
        int value = 0;
        std::from_chars(text.data() + at, text.data() + at + count, value);
        return value;
    };
    const year_month_day day{year{number(0, 4)}, month{static_cast<unsigned>(number(5, 2))},
                             std::chrono::day{static_cast<unsigned>(number(8, 2))}};
    if (!day.ok() || number(0, 4) < 1970 || number(11, 2) > 23 || number(14, 2) > 59 || number(17, 2) > 59) return -1;
    return (sys_days{day}.time_since_epoch() / seconds{1}) + number(11, 2) * 3600 + number(14, 2) * 60 + number(17, 2);
}

bool is_sum(std::string_view text) { return text.size() == 64 && all_hexadecimal(text); }
bool is_abi(std::string_view text) { return text.size() == 16 && all_hexadecimal(text); }
bool is_build_id(std::string_view text) { return text.size() <= 80 && all_hexadecimal(text); }
bool is_kind(std::string_view text) { return std::find(kinds.begin(), kinds.end(), text) != kinds.end(); }
/// Nobody could say whether "new" is before 0.1.0.
bool is_runtime_version(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos && text.front() != '.';
}
bool is_word(std::string_view text) { return !text.empty() && printable(text); }
bool is_time(std::string_view text) { return seconds_of(text) >= 0; }

BundledProgram program_of(const Json& json, std::string& problem) {
    JsonFields keys(json, problem);
    BundledProgram program;
    program.name = keys.text("name", is_bundle_name, "a program's name");
    program.path = keys.text("path", is_packed_path, "a path in the bundle");
    const auto abi = keys.text("abi", is_abi, "16 hexadecimal digits");
    std::from_chars(abi.data(), abi.data() + abi.size(), program.abi, 16);
    program.interface_version = keys.number("interface_version", 0, 1u << 20);
    program.sdk = keys.text("sdk", is_word, "a version");
    program.build_id = keys.text("build_id", is_build_id, "hexadecimal digits");
    return program;
}

BundledFile file_of(const Json& json, std::string& problem) {
    JsonFields keys(json, problem);
    BundledFile file;
    file.path = keys.text("path", is_packed_path, "a path in the bundle");
    file.kind = keys.text("kind", is_kind, "machine, drive, device, program, cam or image");
    file.size = keys.number("size", 0, largest_packed_file);
    file.sha256 = keys.text("sha256", is_sum, "64 hexadecimal digits");
    return file;
}

}  // namespace

bool is_bundle_name(std::string_view text) {
    return !text.empty() && text.size() <= 40 && letter(text.front()) &&
           std::all_of(text.begin(), text.end(), [](char c) { return letter(c) || digit(c) || c == '_' || c == '-'; });
}

bool is_bundle_version(std::string_view text) {
    return !text.empty() && text.size() <= 40 && (letter(text.front()) || digit(text.front())) &&
           std::all_of(text.begin(), text.end(),
                       [](char c) { return letter(c) || digit(c) || c == '.' || c == '_' || c == '+' || c == '-'; });
}

bool version_before(std::string_view a, std::string_view b) {
    while (!a.empty() || !b.empty()) {
        const auto next = [](std::string_view& rest) {
            const auto dot = std::min(rest.find('.'), rest.size());
            std::uint64_t number = 0;
            if (std::from_chars(rest.data(), rest.data() + dot, number).ec == std::errc::result_out_of_range)
                number = std::numeric_limits<std::uint64_t>::max();
            rest.remove_prefix(std::min(dot + 1, rest.size()));
            return number;
        };
        const auto left = next(a), right = next(b);
        if (left != right) return left < right;
    }
    return false;
}

std::string utc_text(std::int64_t seconds) {
    using namespace std::chrono;
    const sys_seconds time{std::chrono::seconds{seconds}};
    const auto day = floor<days>(time);
    const year_month_day date{day};
    const hh_mm_ss clock{time - day};
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                       static_cast<unsigned>(date.day()), clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

std::string text_of(const Manifest& manifest) {
    Json out{{"taktwerk_bundle", Manifest::format},
             {"name", manifest.name},
             {"version", manifest.version},
             {"created", utc_text(manifest.created)},
             {"minimum_runtime", manifest.minimum_runtime},
             {"target", manifest.target},
             {"machine_file", manifest.machine_file}};
    auto& programs = out["programs"] = Json::array();
    for (const auto& program : manifest.programs)
        programs.push_back(Json{{"name", program.name},
                                {"path", program.path},
                                {"abi", fmt::format("{:016x}", program.abi)},
                                {"interface_version", program.interface_version},
                                {"sdk", program.sdk},
                                {"build_id", program.build_id}});
    auto& files = out["files"] = Json::array();
    for (const auto& file : manifest.files)
        files.push_back(Json{{"path", file.path}, {"kind", file.kind}, {"size", file.size}, {"sha256", file.sha256}});
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Manifest> manifest_of(std::string_view text, const std::string& subject) {
    const auto wrong = [&](const std::string& what) {
        return Error{"bundle.manifest", subject, "its manifest cannot be used: " + what, "make the bundle again, or copy it again"};
    };
    if (text.size() > longest_manifest) return wrong(fmt::format("it has more than {} bytes", longest_manifest));
    constexpr int deepest = 4;
    bool too_deep = false;
    // A key that stands twice means one thing to one reader and another thing to the next one; a signature must not stand over both.
    std::array<std::set<std::string>, deepest + 2> keys_at;
    std::string twice;
    const auto json = Json::parse(
        text,
        [&](int depth, Json::parse_event_t event, Json& parsed) {
            too_deep = too_deep || depth > deepest;
            if (too_deep) return false;
            const auto level = static_cast<std::size_t>(depth);
            if (event == Json::parse_event_t::object_start) keys_at[level + 1].clear();
            if (event == Json::parse_event_t::key && !keys_at[level].insert(parsed.get<std::string>()).second)
                twice = parsed.get<std::string>();
            return true;
        },
        false);
    if (!twice.empty() && !too_deep) return wrong(fmt::format("'{}' stands there twice", twice.substr(0, 80)));
    if (too_deep || json.is_discarded() || !json.is_object()) return wrong("it is no JSON of this kind");
    std::string problem;
    JsonFields keys(json, problem);
    if (const auto number = keys.number("taktwerk_bundle", 0, 1u << 20); problem.empty() && number != Manifest::format)
        return Error{"bundle.newer", subject,
                     fmt::format("its form has number {}, and this version knows number {}", number, Manifest::format),
                     "update Taktwerk on this computer, or make the bundle with its version"};
    Manifest out;
    out.name = keys.text("name", is_bundle_name, "a machine's name");
    out.version = keys.text("version", is_bundle_version, "a version");
    out.created = seconds_of(keys.text("created", is_time, "a time such as 2026-11-26T05:12:00Z"));
    out.minimum_runtime = keys.text("minimum_runtime", is_runtime_version, "a version of Taktwerk such as 0.1.0");
    out.target = keys.text("target", is_word, "a word");
    out.machine_file = keys.text("machine_file", is_packed_path, "a path in the bundle");
    for (const auto& program : keys.list("programs", most_packed_files)) out.programs.push_back(program_of(program, problem));
    std::set<std::string, std::less<>> paths;
    for (const auto& file : keys.list("files", most_packed_files)) {
        out.files.push_back(file_of(file, problem));
        if (!paths.insert(out.files.back().path).second && problem.empty())
            problem = fmt::format("'{}' stands there twice", out.files.back().path);
        if (!problem.empty()) break;
    }
    if (!problem.empty()) return wrong(problem);
    if (paths.find(out.machine_file) == paths.end())
        return wrong(fmt::format("the machine file '{}' is not among its files", out.machine_file));
    for (const auto& program : out.programs)
        if (paths.find(program.path) == paths.end())
            return wrong(fmt::format("'{}' of program '{}' is not among its files", program.path, program.name));
    // A file that is also a folder of another one could never be written.
    for (const auto& path : paths)
        for (auto slash = path.find('/'); slash != std::string::npos; slash = path.find('/', slash + 1))
            if (paths.find(std::string_view(path).substr(0, slash)) != paths.end()) return wrong(fmt::format("'{}' lies in a file", path));
    return out;
}

}  // namespace taktwerk::runtime
