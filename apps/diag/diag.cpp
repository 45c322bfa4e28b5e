// taktwerk diag: what somebody far away needs to see, as one file.

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "apps/diag/gather.hpp"
#include "apps/diag/mask.hpp"
#include "apps/diag/tar.hpp"
#include "apps/machine/load.hpp"
#include "apps/machine/remote.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "apps/terminal/text_table.hpp"
#include "hmi_bridge/wall_clock.hpp"
#include "runtime/signature/sha256.hpp"
#include "runtime/stamped_name.hpp"

namespace taktwerk::apps {
namespace {

struct DiagOptions {
    std::string file, machine, out, interface;
    bool list = false;
};

std::string size_of(std::size_t bytes) {
    return bytes >= 1'000'000 ? fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6)
           : bytes >= 1000    ? fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1e3)
                              : fmt::format("{} B", bytes);
}

std::string contents(const Gathered& all) {
    std::string text = "SHA-256                                                           bytes  file\n";
    for (const auto& part : all.parts)
        text += fmt::format("{} {:>10}  {}: {}\n", runtime::hexadecimal(runtime::sha256_of(part.bytes)), part.bytes.size(), part.path,
                            part.about);
    text += "\nMasked:\n";
    bool any = false;
    for (const auto& part : all.parts)
        for (const auto& where : part.masked) {
            text += fmt::format("  {} {}\n", part.path, where);
            any = true;
        }
    if (!any) text += "  nothing\n";
    text += "\nNot in it:\n";
    for (const auto& missing : all.missing) text += "  " + missing + "\n";
    if (all.missing.empty()) text += "  nothing\n";
    return text;
}

void print_contents(const Gathered& all) {
    TextTable table{{{"file"}, {"size", TextTable::Column::Side::right}, {"", TextTable::Column::Side::left, 70}}};
    std::size_t whole = 0, secrets = 0;
    for (const auto& part : all.parts) {
        table.add({part.path, size_of(part.bytes.size()), part.about});
        whole += part.bytes.size();
        secrets += part.masked.size();
    }
    fmt::print("{}{} in {} files\n", table.text(colours_of_output()), size_of(whole), all.parts.size());
    fmt::print("\nMasked: {}\n", secrets == 0 ? "nothing looked like a secret; look yourself before you send it" : std::to_string(secrets));
    for (const auto& part : all.parts)
        for (const auto& where : part.masked) fmt::print("  {} {}\n", part.path, where);
    if (!all.missing.empty()) fmt::print("Not in it:\n");
    for (const auto& missing : all.missing) fmt::print("  {}\n", missing);
}

/// For its owner alone: it holds what a machine is and does. Nothing is written over.
Result<std::size_t> write_archive(const std::string& path, const Gathered& all, const std::string& folder) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0)
        return Error{"diag.not_written", path, fmt::format("cannot be made: {}", std::strerror(errno)),
                     errno == EEXIST ? "choose another name with -o; nothing is written over" : "choose another place with -o"};
    const auto now = hmi::wall_utime() / 1'000'000;
    std::size_t written = 0;
    bool ok = true;
    const auto put = [&](const std::string& bytes) {
        for (std::size_t at = 0; ok && at < bytes.size();) {
            const auto got = ::write(file, bytes.data() + at, bytes.size() - at);
            if (got < 0 && errno == EINTR) continue;
            ok = got > 0;
            if (ok) at += static_cast<std::size_t>(got);
        }
        written += bytes.size();
    };
    put(tar_member(folder + "/contents.txt", contents(all), now));
    for (const auto& part : all.parts) put(tar_member(folder + "/" + part.path, part.bytes, now));
    put(tar_end());
    ok = ok && ::fsync(file) == 0;
    const int number = errno;
    ::close(file);
    if (ok) return written;
    ::unlink(path.c_str());
    return Error{"diag.not_written", path, fmt::format("could not be written whole, and was removed: {}", std::strerror(number)),
                 "make room, or choose another disk with -o"};
}

/// Where a machine of this name has its file as a service.
std::string service_file(const std::string& machine) {
    const auto path = "/etc/taktwerk/" + machine + ".yaml";
    std::error_code ignored;
    return machine.find('/') == std::string::npos && std::filesystem::exists(path, ignored) ? path : std::string{};
}

int run_diag(const DiagOptions& options) {
    Gathered all;
    auto wanted = options.machine;
    std::string interface = options.interface;
    if (std::error_code ignored; !options.file.empty() && !std::filesystem::is_regular_file(options.file, ignored)) {
        print_error(
            {"diag.no_file", options.file, ignored ? ignored.message() : "it is no file", "give the path of its machine file, or none"});
        return exit_bad_file;
    }
    if (!options.file.empty()) {
        const auto loaded = read_machine_without_programs(options.file, false);
        if (const auto* machine = std::get_if<LoadedFile>(&loaded)) {
            if (wanted.empty()) wanted = machine->machine.name;
            if (interface.empty()) interface = machine->machine.bus.interface;
        }
    }
    auto client = hmi::Client::connect(wanted);
    bool answers = client.ok();
    if (client) {
        // Until it says so itself: it may hang.
        all.machine = std::filesystem::path(client->path()).stem().string();
        const auto done = understood(client->path(), [&] {
            const auto hello = client->request({{"cmd", "hello"}});
            if (!hello && hello.error().code == "socket.timeout") {
                all.missing.push_back("everything that a running machine says: " + hello.error().text());
                answers = false;
                return 0;
            }
            if (hello) all.machine = hello->value("hello", nlohmann::ordered_json::object()).value("machine", "");
            const auto layout = client->request({{"cmd", "layout"}});
            if (layout && interface.empty()) interface = layout->value("layout", nlohmann::ordered_json::object()).value("interface", "");
            answers = gather_running(all, *client);
            return 0;
        });
        if (!done) all.missing.push_back(done.error().text());
    } else if (client.error().code == "socket.ambiguous" ||
               (options.file.empty() && !options.machine.empty() && service_file(options.machine).empty())) {
        print_error(client.error());
        return client.error().code == "socket.ambiguous" ? exit_usage : exit_no_runtime;
    } else {
        all.machine = wanted;
        all.missing.push_back("state, statistics, bus counters, log: " + client.error().text());
    }
    const auto file = !options.file.empty() ? options.file : service_file(all.machine);
    if (!file.empty()) gather_files(all, file, answers);
    else all.missing.push_back("machine file: not known; `taktwerk diag MACHINE.yaml` packs it");
    gather_host(all, interface);
    mask_reasons(all);

    const auto name = all.machine.empty() ? std::string("host") : all.machine;
    const auto stamped = runtime::stamped_name(name, std::chrono::microseconds{hmi::wall_utime()}, "diag", "");
    print_contents(all);
    if (options.list) return exit_ok;
    const auto path = options.out.empty() ? stamped + ".tar" : options.out;
    const auto written = write_archive(path, all, stamped);
    if (!written) return print_error(written.error()), exit_bad_file;
    fmt::print("\n{}, {}: {}\n", std::filesystem::absolute(path).string(), size_of(*written),
               "look into it with `tar tf`; readable by you alone");
    return exit_ok;
}

}  // namespace

void add_diag(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand(
        "diag",
        "everything that somebody far away needs to see of a machine, as one file; secrets are masked, and what goes in is listed first");
    auto options = std::make_shared<DiagOptions>();
    sub->add_option("FILE", options->file, "its machine file; a service's is found in /etc/taktwerk");
    sub->add_option("-s,--socket,--machine", options->machine, "machine name or socket path; needed only when several machines run");
    sub->add_option("-o,--output", options->out, "the archive (tar); default: MACHINE-TIME-diag.tar here");
    sub->add_option("--nic", options->interface, "network interface for the doctor; default: that of the machine");
    sub->add_flag("--list", options->list, "only list what would go in");
    sub->callback([&action, options] { action = [options] { return run_diag(*options); }; });
}

}  // namespace taktwerk::apps
