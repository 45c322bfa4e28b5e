#include "apps/machine/systemd_link.hpp"

#include <unistd.h>

#include <charconv>

#include <fmt/format.h>

#include "core/one_line.hpp"

namespace taktwerk::apps {
namespace {

constexpr Duration each_second = std::chrono::seconds{1};
/// More than a bring-up is silent: a drive that is switched on beside it may take that long.
constexpr Duration further = std::chrono::seconds{30};

std::optional<std::uint64_t> number(const char* text) {
    if (text == nullptr) return std::nullopt;
    const std::string_view all = text;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), value);
    if (error != std::errc{} || end != all.data() + all.size()) return std::nullopt;
    return value;
}

}  // namespace

SystemdLink::SystemdLink(const Environment& environment) {
    if (const char* socket = environment("NOTIFY_SOCKET"); socket != nullptr) out_ = DatagramOut{socket};
    const auto time = number(environment("WATCHDOG_USEC"));
    const auto process = number(environment("WATCHDOG_PID"));
    if (time && *time > 0 && (!process || *process == static_cast<std::uint64_t>(::getpid())))
        watchdog_ = std::chrono::microseconds{static_cast<std::int64_t>(*time)};
}

void SystemdLink::starting(Instant now, std::string_view text) {
    if (ready_) return;
    status(text);
    if (extended_once_ && now - extended_ < each_second) return;
    extended_once_ = true;
    extended_ = now;
    out_.send(fmt::format("EXTEND_TIMEOUT_USEC={}", further / std::chrono::microseconds{1}));
}

void SystemdLink::ready() {
    if (ready_) return;
    ready_ = true;
    out_.send("READY=1");
}

void SystemdLink::status(std::string_view line) {
    if (!out_.open() || line == status_) return;
    status_ = line;
    out_.send("STATUS=" + on_one_line(status_));
}

void SystemdLink::alive(Instant now, std::uint64_t cycles) {
    if (!watchdog_ || cycles == cycles_ || (fed_once_ && now - fed_ < *watchdog_ / 4)) return;
    cycles_ = cycles;
    fed_ = now;
    fed_once_ = true;
    out_.send("WATCHDOG=1");
}

void SystemdLink::stopping() {
    if (stopping_) return;
    stopping_ = true;
    out_.send("STOPPING=1");
}

}  // namespace taktwerk::apps
