#include "apps/diag/gather.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "apps/diag/mask.hpp"
#include "apps/doctor/examine.hpp"
#include "apps/doctor/host_files.hpp"
#include "apps/machine/about.hpp"
#include "apps/machine/history_file.hpp"
#include "apps/machine/load.hpp"
#include "runtime/stamped_name.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* state_folder = "/var/lib/taktwerk";

/// Of a regular file of a size that goes in: nobody waits for a pipe, and a device has no end.
std::optional<std::string> whole_file(const fs::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) return std::nullopt;
    struct stat info {};
    bool ok = ::fstat(file, &info) == 0 && S_ISREG(info.st_mode);
    std::string all;
    std::array<char, 65536> some;
    while (ok && all.size() <= most_recording_bytes) {
        const auto got = ::read(file, some.data(), some.size());
        if (got < 0 && errno == EINTR) continue;
        ok = got >= 0;
        if (got <= 0) break;
        all.append(some.data(), static_cast<std::size_t>(got));
    }
    ::close(file);
    return ok && all.size() <= most_recording_bytes ? std::optional{std::move(all)} : std::nullopt;
}

std::string free_path(const Gathered& all, const std::string& path) {
    const auto taken = [&](const std::string& wanted) {
        return std::any_of(all.parts.begin(), all.parts.end(), [&](const DiagPart& part) { return part.path == wanted; });
    };
    const fs::path whole(path);
    auto wished = path;
    for (int i = 2; taken(wished); ++i)
        wished = (whole.parent_path() / fmt::format("{}.{}{}", whole.stem().string(), i, whole.extension().string())).string();
    return wished;
}

/// A machine that does not answer one question in time answers no other one either, and each would take as long.
bool hangs(const Error& error) { return error.code == "socket.timeout"; }

bool is_plain(std::string_view name) {
    return !name.empty() && name.front() != '-' &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-") == std::string_view::npos;
}

/// Bytes of one piece of a recording; nothing where it is not base64 of RFC 4648.
std::optional<std::string> from_base64(const std::string& text) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    unsigned bits = 0, held = 0;
    for (const char c : text) {
        if (c == '=') break;
        const auto value = letters.find(c);
        if (value == std::string_view::npos) return std::nullopt;
        bits = (bits << 6 | static_cast<unsigned>(value)) & 0xFFFF;
        held += 6;
        if (held >= 8) {
            held -= 8;
            out += static_cast<char>(bits >> held & 0xFF);
        }
    }
    return out;
}

/// False: it hangs.
bool ask(Gathered& all, hmi::Client& client, const char* question, const char* about) {
    const auto answer = client.request({{"cmd", question}});
    if (!answer) {
        all.missing.push_back(fmt::format("{}: {}", about, answer.error().text()));
        return !hangs(answer.error());
    }
    add_text(all, fmt::format("running/{}.json", question), about, answer->dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    return true;
}

void gather_log(Gathered& all, hmi::Client& client) {
    std::string text;
    std::int64_t after = 0;
    for (int pages = 0; pages < 8; ++pages) {  // it keeps 2000 lines, an answer has 500
        const auto answer = client.request({{"cmd", "log"}, {"after", after}, {"limit", 500}});
        if (!answer) {
            if (text.empty()) return all.missing.push_back("log: " + answer.error().text());
            break;
        }
        const auto lines = (*answer)["log"].value("lines", Json::array());
        std::string page;
        for (const auto& line : lines) page += line.value("text", "") + "\n";
        text += page;
        const auto last = (*answer)["log"].value("last", std::int64_t{0});
        if (lines.empty() || last <= after) break;
        after = lines.back().value("number", last);
        if (after >= last) break;
    }
    add_text(all, "running/log.txt", "the runtime's log", std::move(text));
}

std::optional<std::string> recording(hmi::Client& client, const std::string& name, std::string& why) {
    std::string bytes;
    for (;;) {
        const auto answer = client.request({{"cmd", "recording_part"}, {"recording", name}, {"from", bytes.size()}});
        if (!answer) return why = answer.error().text(), std::nullopt;
        const auto more = from_base64(answer->value("data", ""));
        if (!more) return why = "the answer is not what this version understands", std::nullopt;
        bytes += *more;
        const auto size = answer->value("size", std::size_t{0});
        if (bytes.size() >= size || more->empty()) return bytes;
        if (size > most_recording_bytes) return why = "it is larger than 64 MB", std::nullopt;
    }
}

void gather_recordings(Gathered& all, hmi::Client& client) {
    const auto answer = client.request({{"cmd", "recordings"}});
    if (!answer) return all.missing.push_back("recordings: " + answer.error().text());
    std::size_t count = 0, left_out = 0, room = most_recording_bytes;
    for (const auto& each : answer->value("recordings", Json::array())) {
        const auto name = each.value("name", "");
        if (!is_plain(name)) continue;
        if (count == most_recordings || each.value("bytes", std::size_t{0}) > room) {
            ++left_out;
            continue;
        }
        std::string why;
        auto bytes = recording(client, name, why);
        if (!bytes) {
            all.missing.push_back("recording " + name + ": " + why);
            continue;
        }
        room -= std::min(room, bytes->size());
        ++count;
        all.parts.push_back({"recordings/" + name + (name.ends_with(".twscope") ? "" : ".twscope"),
                             fmt::format("every signal around {} of {}", each.value("alarm", ""), each.value("source", "")),
                             std::move(*bytes)});
    }
    if (left_out > 0)
        all.missing.push_back(fmt::format("{} older recordings: the newest {} and {} MB at most are packed", left_out, most_recordings,
                                          most_recording_bytes >> 20));
}

/// Of a machine that does not run: what lies where services keep it.
void gather_kept(Gathered& all) {
    const char* given = std::getenv("STATE_DIRECTORY");
    const fs::path folder = given != nullptr && *given != '\0' ? given : state_folder;
    const auto history = history_path(folder.string(), all.machine);
    if (auto bytes = whole_file(history); bytes && bytes->size() <= most_recording_bytes)
        all.parts.push_back({"kept/" + fs::path(history).filename().string(), "alarm history (SQLite)", std::move(*bytes)});
    else all.missing.push_back(fmt::format("alarm history: {} is not there or cannot be read", history));
    std::vector<fs::path> files;
    std::error_code failed;
    for (auto it = fs::directory_iterator(folder / "recordings", failed); !failed && it != fs::directory_iterator{}; it.increment(failed))
        if (runtime::is_stamped(it->path().filename().string(), all.machine, ".twscope")) files.push_back(it->path());
    std::sort(files.rbegin(), files.rend());  // their names sort by time
    std::size_t room = most_recording_bytes;
    for (std::size_t i = 0; i < files.size() && i < most_recordings; ++i)
        if (auto bytes = whole_file(files[i]); bytes && bytes->size() <= room) {
            room -= bytes->size();
            all.parts.push_back({"recordings/" + files[i].filename().string(), "every signal around an alarm", std::move(*bytes)});
        }
    if (files.empty()) all.missing.push_back(fmt::format("recordings: none of {} in {}", all.machine, (folder / "recordings").string()));
}

/// A command's output; nothing where it cannot be run. Its words are ours alone.
std::optional<std::string> output_of(const std::string& command) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe{::popen((command + " 2>/dev/null").c_str(), "re"), ::pclose};
    if (!pipe) return std::nullopt;
    std::string out;
    std::array<char, 4096> some{};
    for (std::size_t got = 0; (got = std::fread(some.data(), 1, some.size(), pipe.get())) > 0;) out.append(some.data(), got);
    return out;
}

std::string versions(const HostFiles& host) {
    std::string text;
    const auto of = about();
    for (const auto& part : of.libraries) text += fmt::format("{:<14} {}\n", part.name, part.version);
    text += "\n" + host.text("/proc/version").value_or("") + "\n" + host.text("/etc/os-release").value_or("") + "\n";
    return text;
}

}  // namespace

void add_text(Gathered& all, std::string path, std::string about, std::string text) {
    // Masked first: behind a cut a secret would stand without its key.
    auto clean = masked(text);
    if (clean.text.size() > most_text_bytes) {
        const auto from = clean.text.size() - most_text_bytes;
        const auto line = clean.text.find('\n', from);
        clean.text = clean.text.substr(line == std::string::npos ? from : line + 1);
        about += fmt::format(" (its last {} MB; lines that are masked are counted from its beginning)", most_text_bytes >> 20);
    }
    all.parts.push_back({free_path(all, path), std::move(about), std::move(clean.text), std::move(clean.where)});
}

void mask_reasons(Gathered& all) {
    for (auto& reason : all.missing) reason = masked(reason).text;
}

bool gather_running(Gathered& all, hmi::Client& client) {
    constexpr std::array questions{std::pair{"hello", "what runs"},
                                   std::pair{"state", "everything that people see: axes, points, programs, bus and cycle counters, alarms"},
                                   std::pair{"layout", "names, units, limits"}, std::pair{"histograms", "times of cycle, steps and tasks"},
                                   std::pair{"bus", "the tree of slaves with their counters"}};
    for (const auto& [question, about] : questions)
        if (!ask(all, client, question, about)) {
            all.missing.push_back("everything else that a running machine says: it does not answer, and was not asked any more");
            return false;
        }
    const auto history = client.request({{"cmd", "alarm_history"}, {"limit", 500}}, std::chrono::seconds{8});
    if (history)
        add_text(all, "running/alarm_history.json", "the newest 500 alarms",
                 history->dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    else all.missing.push_back("alarm history: " + history.error().text());
    gather_log(all, client);
    gather_recordings(all, client);
    return true;
}

void gather_files(Gathered& all, const std::string& machine_file, bool runs) {
    const auto name = fs::path(machine_file).filename().string();
    auto text = whole_file(machine_file);
    if (!text) return all.missing.push_back(machine_file + ": cannot be read");
    add_text(all, "machine/" + name, "the machine file", std::move(*text));
    const auto loaded = read_machine_without_programs(machine_file, false);
    if (const auto* problems = std::get_if<std::vector<Error>>(&loaded)) {
        std::string said;
        for (const auto& problem : *problems) said += problem.text() + "\n";
        add_text(all, "machine/problems.txt", "what is wrong in it", std::move(said));
        if (!runs && !all.machine.empty()) gather_kept(all);
        return;
    }
    const auto& machine = std::get<LoadedFile>(loaded);
    if (all.machine.empty()) all.machine = machine.machine.name;
    for (const auto& used : machine.files) {
        if (used.kind == config::UsedFile::Kind::program || used.kind == config::UsedFile::Kind::image) continue;
        if (auto found = whole_file(used.path); found && found->size() <= most_text_bytes)
            add_text(all, "machine/" + fs::path(used.path).filename().string(), fmt::format("a file that it names: {}", used.path),
                     std::move(*found));
        else all.missing.push_back(used.path + ": cannot be read");
    }
    if (!runs) gather_kept(all);
}

void gather_host(Gathered& all, const std::string& interface) {
    const HostFiles host;
    add_text(all, "host/versions.txt", "Taktwerk, its libraries, kernel, distribution", versions(host));
    KernelEthernetPorts ports;
    const auto seen = examine("/", ports, Wanted{}, interface);
    add_text(all, "host/doctor.txt", "what the doctor finds, without measuring", report_text(seen, Colours::off, 100, Sources::shown));
    add_text(all, "host/doctor.json", "the same for programs",
             report_json(seen).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    for (const auto& [path, about] : {std::pair{"/proc/cmdline", "kernel parameters"},
                                      {"/proc/interrupts", "who interrupts which CPU"},
                                      {"/proc/cpuinfo", "CPUs"},
                                      {"/proc/meminfo", "memory"},
                                      {"/proc/net/dev", "counters of the network interfaces"}}) {
        if (auto text = host.text(path)) add_text(all, fmt::format("host/{}.txt", fs::path(path).filename().string()), about, *text + "\n");
        else all.missing.push_back(fmt::format("{}: cannot be read", path));
    }
    if (!is_plain(all.machine)) return;
    auto journal = output_of(fmt::format("journalctl -u taktwerk@{} -n 5000 --no-pager -o short-iso-precise", all.machine));
    if (journal && !journal->empty() && !journal->starts_with("-- No entries"))
        add_text(all, "host/journal.txt", "the journal of its unit", std::move(*journal));
    else all.missing.push_back(fmt::format("journal of taktwerk@{}: there is none, or this user may not read it", all.machine));
}

}  // namespace taktwerk::apps
