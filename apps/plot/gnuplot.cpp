#include "apps/plot/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace taktwerk::apps {
namespace {

/// Deleted with everything in it at the end.
class ScratchFolder {
public:
    ScratchFolder() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-plot-XXXXXX").string();
        if (::mkdtemp(pattern.data())) path_ = pattern;
    }
    ~ScratchFolder() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

std::string file_text(const std::filesystem::path& path) {
    std::string text;
    if (auto* file = std::fopen(path.c_str(), "r")) {
        std::array<char, 2048> part{};
        text.assign(part.data(), std::fread(part.data(), 1, part.size(), file));
        std::fclose(file);
    }
    return text;
}

}  // namespace

bool write_file(const std::filesystem::path& path, const std::string& text) {
    auto* file = std::fopen(path.c_str(), "w");
    if (!file) return false;
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    return std::fclose(file) == 0 && written;
}

Result<void> draw_with_gnuplot(const std::string& script) {
    const ScratchFolder scratch;
    const auto script_file = scratch.path() / "plot.gp", messages = scratch.path() / "messages";
    if (scratch.path().empty() || !write_file(script_file, script))
        return Error{"plot.scratch", std::filesystem::temp_directory_path().string(), "no room for the plot's data",
                     "Free space there, or set TMPDIR to another place."};

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    // -d: nobody's start-up files.
    std::string program = "gnuplot", as_delivered = "-d", script_name = script_file.string();
    std::array<char*, 4> arguments{program.data(), as_delivered.data(), script_name.data(), nullptr};
    pid_t child = 0;
    const int failed = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (failed == 0)
        while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    if (failed == ENOENT || (WIFEXITED(status) && WEXITSTATUS(status) == 127))
        return Error{"plot.no_gnuplot", "gnuplot", "it is not installed, and it draws the picture",
                     "Install it: apt-get install gnuplot-nox"};
    if (failed != 0)
        return Error{"plot.gnuplot", "gnuplot", fmt::format("it cannot be started: {}", std::strerror(failed)),
                     "Try to run it by hand: gnuplot --version"};
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return Error{"plot.gnuplot", "gnuplot", fmt::format("it did not draw the picture: {}", file_text(messages)),
                     "Report this: the script is made by this command."};
    return {};
}

std::string in_gnuplot_quotes(std::string_view text) {
    // A doubled quote directly behind the opening one would be an empty string to it.
    std::string out = text.starts_with('\'') ? "' " : "'";
    for (const char c : text) {
        if (c == '\'') out += '\'';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + '\'';
}

std::string gnuplot_file(const std::string& path) { return in_gnuplot_quotes(path.starts_with('/') ? path : "./" + path); }

}  // namespace taktwerk::apps
