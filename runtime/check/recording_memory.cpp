#include "runtime/check/recording_memory.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

constexpr const char* subject = "recording.depth";

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / 1e6; }

std::string takes(Duration depth, std::size_t bytes) {
    return fmt::format("{:g} s of every signal of every cycle take {:.0f} MB, locked in memory while the machine runs", to_seconds(depth),
                       megabytes(bytes));
}

/// The depth that takes so many bytes; a readable number.
std::string remedy(Duration depth, std::size_t bytes, std::size_t wanted) {
    const double s = to_seconds(depth) * static_cast<double>(wanted) / static_cast<double>(bytes);
    return fmt::format("write `recording: {{depth: {:g} s}}` or less, with `before` and `after` that fit into it",
                       s >= 1 ? std::floor(s) : std::max(std::floor(s * 10) / 10, 0.1));
}

}  // namespace

std::optional<Error> recording_remark(Duration depth, std::size_t bytes, std::size_t installed) {
    if (bytes <= much_recording_memory) return std::nullopt;
    const auto of = installed > 0 ? fmt::format(" (this computer has {:.0f} MB)", megabytes(installed)) : std::string{};
    auto fits = recording_fits(depth, bytes, installed);
    return Error{"remark.recording_memory", subject, takes(depth, bytes) + of + (fits ? "" : ": `run` would refuse that here"),
                 remedy(depth, bytes, much_recording_memory)};
}

Result<void> recording_fits(Duration depth, std::size_t bytes, std::size_t installed) {
    if (installed == 0 || bytes <= installed / most_recording_share) return {};
    return Error{"recording.memory", subject, fmt::format("{}, and this computer has {:.0f} MB", takes(depth, bytes), megabytes(installed)),
                 remedy(depth, bytes, installed / most_recording_share)};
}

}  // namespace taktwerk::runtime
