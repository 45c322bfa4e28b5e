// taktwerk monitor: a running machine on the terminal, a few times a second.

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "apps/machine/monitor_screen.hpp"
#include "apps/machine/remote.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/terminal_size.hpp"

namespace taktwerk::apps {
namespace {

constexpr int refresh_ms = 200;

struct MonitorOptions {
    RemoteOptions remote;
    bool once = false;
};

/// The alternate screen without cursor and echo; as it was before at the end.
class RawTerminal {
public:
    RawTerminal() {
        keys_ = ::isatty(STDIN_FILENO) != 0 && ::tcgetattr(STDIN_FILENO, &before_) == 0;
        if (keys_) {
            auto raw = before_;
            raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
            ::tcsetattr(STDIN_FILENO, TCSANOW, &raw);
        }
        fmt::print("\033[?1049h\033[?25l");
    }
    ~RawTerminal() {
        fmt::print("\033[?25h\033[?1049l");
        std::fflush(stdout);
        if (keys_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    }
    RawTerminal(const RawTerminal&) = delete;
    RawTerminal& operator=(const RawTerminal&) = delete;

    /// Waits up to `ms`; true when `q` was pressed.
    bool quit_pressed(int ms) const {
        pollfd ready{keys_ ? STDIN_FILENO : -1, POLLIN, 0};
        if (::poll(&ready, 1, ms) <= 0) return false;
        char key = 0;
        return ::read(STDIN_FILENO, &key, 1) == 1 && (key == 'q' || key == 'Q');
    }

private:
    termios before_{};
    bool keys_ = false;
};

ScreenSize screen_size() {
    // Into a pipe or a file: nothing is cut, whoever reads it wraps as he likes.
    constexpr std::size_t whole_line = 1000, least = 40;
    const auto terminal = terminal_size();
    return terminal ? ScreenSize{std::max(terminal->columns, least), terminal->rows, true} : ScreenSize{whole_line, 0, false};
}

int once(const MonitorOptions& options, hmi::Client& client) {
    const auto state = state_of(client);
    if (!state) return report(options.remote, state.error());
    if (options.remote.json) {
        fmt::print("{}\n", state->dump());
        return exit_ok;
    }
    const auto layout = layout_of(client);
    if (!layout) return report(options.remote, layout.error());
    auto size = screen_size();
    size.rows = 0;
    for (const auto& line : monitor_screen(*state, *layout, size))
        fmt::print("{}\n", std::string_view(line).substr(0, line.find_last_not_of(' ') + 1));
    return exit_ok;
}

/// A line of JSON each time, for scripts.
int stream(const MonitorOptions& options, hmi::Client& client) {
    while (!stop_requested()) {
        const auto state = state_of(client);
        if (!state && state.error().code != "state.not_yet") return report(options.remote, state.error());
        if (state) fmt::print("{}\n", state->dump());
        if (std::fflush(stdout) != 0) return exit_ok;  // the reader has gone
        ::poll(nullptr, 0, refresh_ms);
    }
    return exit_ok;
}

int watch(const MonitorOptions& options, hmi::Client& client) {
    std::optional<Error> ended;
    {
        const RawTerminal terminal;
        nlohmann::ordered_json layout;
        while (!stop_requested()) {
            const auto size = screen_size();
            std::vector<std::string> lines;
            if (layout.is_null()) {
                if (auto answer = layout_of(client)) layout = std::move(*answer);
            }
            auto state = state_of(client);
            if (state && !layout.is_null()) lines = monitor_screen(*state, layout, {size.columns, size.rows > 2 ? size.rows - 1 : 1, true});
            else if (!state && state.error().code == "state.not_yet") lines = {" " + state.error().what};
            else if (!state) {
                ended = state.error();
                break;
            }
            std::string frame = "\033[H";
            for (const auto& line : lines) frame += line + "\033[K\n";
            frame += "\033[J";
            if (lines.size() + 1 <= size.rows) frame += fmt::format("\033[{};1H\033[2m q quits\033[0m", size.rows);
            std::fwrite(frame.data(), 1, frame.size(), stdout);
            std::fflush(stdout);
            if (terminal.quit_pressed(refresh_ms)) break;
        }
    }
    return ended ? report(options.remote, *ended) : static_cast<int>(exit_ok);
}

int monitor(const MonitorOptions& options, hmi::Client& client) {
    watch_stop_signals();
    if (options.once) return once(options, client);
    if (options.remote.json) return stream(options, client);
    if (::isatty(STDOUT_FILENO) == 0) return once(options, client);
    return watch(options, client);
}

}  // namespace

void add_monitor(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("monitor", "watch a running machine on the terminal");
    auto options = std::make_shared<MonitorOptions>();
    add_remote_options(*sub, options->remote);
    sub->add_flag("--once", options->once, "print the present state and end");
    sub->callback([&action, options] {
        action = [options] { return with_machine(options->remote, [&](hmi::Client& client) { return monitor(*options, client); }); };
    });
}

}  // namespace taktwerk::apps
