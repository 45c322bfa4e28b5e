// taktwerk lcm record: everything that is said, in LCM's own log format.

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "apps/lcm/channel_book.hpp"
#include "apps/lcm/lcm.hpp"
#include "apps/lcm/network.hpp"
#include "apps/lcm/split_log.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "core/clock.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

constexpr Duration flushed_each = 1s;
constexpr int messages_of_a_turn = 1000;

struct RecordOptions {
    NetworkOptions network;
    std::string file, channel = ".*";
    double for_s = 0;
    int megabytes = 1000, keep = 0;
};

int record(const RecordOptions& options) {
    const auto catalog = types_of(options.network);
    if (!catalog) {
        print_error(catalog.error());
        return exit_bad_file;
    }
    watch_stop_signals();
    const auto bus = open_network(options.network);
    if (!bus) {
        print_error(bus.error());
        return exit_bus;
    }
    auto log = SplitLog::create(options.file, {static_cast<std::uint64_t>(options.megabytes) * 1'000'000, options.keep});
    if (!log) {
        print_error(log.error());
        return exit_bad_file;
    }
    ChannelBook book(*catalog);
    std::optional<Error> broken;
    bool full = false;
    const auto keep = [&](std::string_view channel, std::span<const std::byte> message, std::int64_t utime) {
        if (broken || full) return;
        const auto wrote = log->write(utime, channel, message);
        if (!wrote) broken = wrote.error();
        else if (*wrote == SplitLog::Wrote::full) full = true;
        else book.note(channel, message, utime);
    };
    if (!(*bus)->subscribe_matching(options.channel, room_for_messages, keep)) {
        print_error({"lcm.channel", options.channel, "this is no regular expression", "Write one such as 'TAKTWERK_DEMO_.*'."});
        return exit_usage;
    }
    fmt::print("recording into {}; Ctrl-C ends\n", options.keep > 0 ? options.file + ".0001, ..." : options.file);
    std::fflush(stdout);
    SystemClock clock;
    const auto end = options.for_s > 0 ? clock.now() + from_seconds(options.for_s) : Instant::max();
    for (auto next = clock.now() + flushed_each; !stop_requested() && !broken && !full && clock.now() < end;) {
        (*bus)->wait(std::max(Duration{1ms}, std::min({next, end, clock.now() + 100ms}) - clock.now()), messages_of_a_turn);
        if (clock.now() < next) continue;
        next = clock.now() + flushed_each;
        if (auto ok = log->flush(); !ok) broken = ok.error();
    }
    (*bus)->poll(room_for_messages);  // what had come before the end was asked for
    if (auto ok = log->flush(); !ok && !broken) broken = ok.error();
    fmt::print("{} of {}, {:.1f} MB in {}\n", count_text(book.messages(), "message"), count_text(book.rows(0).size(), "channel"),
               static_cast<double>(log->bytes()) / 1e6,
               options.keep > 0 ? fmt::format("{} files, the last is {}", log->files(), log->last_file()) : log->last_file());
    // Of some channels alone the count of a machine has holes that are no losses.
    if (options.channel == ".*")
        for (const auto& machine : book.machines())
            fmt::print("{}*: {} lost on the way to here\n", machine.prefix, count_text(machine.lost, "message"));
    if (full)
        print_warning({"lcm.log_full", options.file, fmt::format("{} MB are full: what came behind is not in it", options.megabytes),
                       "Give --mb more, or --keep N to go on in further files."});
    if (!broken) return exit_ok;
    print_error(*broken);
    return exit_bad_file;
}

}  // namespace

void add_lcm_record(CLI::App& lcm, Action& action) {
    auto* sub = lcm.add_subcommand("record", "keeps everything that is said in a file, for `play` and for lcm-logplayer");
    auto options = std::make_shared<RecordOptions>();
    sub->add_option("FILE", options->file, "log to write; one that is there is not written over")->required();
    add_network_options(*sub, options->network);
    sub->add_option("--channel", options->channel, "only these: a regular expression of the whole name");
    sub->add_option("--mb", options->megabytes, "so large a file gets (1000): then it ends, or the next one begins")
        ->check(CLI::Range(1, 1'000'000));
    sub->add_option("--keep", options->keep, "go on in FILE.0001, FILE.0002, ... and keep so many, the newest")->check(CLI::Range(1, 9999));
    add_duration(*sub, "--for", options->for_s, "end after this time");
    sub->callback([&action, options] { action = [options] { return record(*options); }; });
}

}  // namespace taktwerk::apps
