#include "apps/machine/bundle_run.hpp"

#include <pwd.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <limits>

#include <fmt/format.h>

namespace taktwerk::apps {

namespace {

std::string user_text(std::uint32_t id) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before any thread is started
    const auto* entry = ::getpwuid(id);
    return entry != nullptr ? fmt::format("{} ({})", entry->pw_name, id) : fmt::format("user {}", id);
}

}  // namespace

std::filesystem::path bundle_root(const std::string& given) {
    if (!given.empty()) return given;
    // systemd gives a list with colons between, where a unit has several.
    if (const char* state = std::getenv("STATE_DIRECTORY"); state != nullptr && *state == '/') {
        const std::string folders = state;
        return folders.substr(0, folders.find(':'));
    }
    return "/var/lib/taktwerk";
}

runtime::Deed deed_now() {
    // Who logged in, whatever became of the user since: sudo does not change it.
    constexpr auto nobody = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t came_as = nobody;
    std::ifstream login("/proc/self/loginuid");
    if (std::string text; login >> text) std::from_chars(text.data(), text.data() + text.size(), came_as);
    const auto now = std::chrono::system_clock::now().time_since_epoch() / std::chrono::seconds{1};
    auto who = user_text(::getuid());
    if (came_as != nobody && came_as != ::getuid()) who = fmt::format("{} as {}", user_text(came_as), who);
    return {std::move(who), now};
}

std::string BundleRun::title() const {
    const auto& manifest = start_.bundle.manifest;
    return fmt::format("{} {}, made at {}", manifest.name, manifest.version, runtime::utc_text(manifest.created));
}

void BundleRun::look(const runtime::Snapshot* snapshot) noexcept {
    if (snapshot != nullptr && snapshot->phase == runtime::MachinePhase::running) reached_.store(true, std::memory_order_release);
}

Result<void> BundleRun::work() {
    if (written_ || !reached()) return {};
    auto done = runtime::start_succeeded(start_.activation);
    written_ = done.ok();
    return done;
}

void BundleRun::ended_as_asked() {
    if (!reached()) runtime::start_was_ended(start_.activation);
}

}  // namespace taktwerk::apps
