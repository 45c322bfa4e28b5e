#pragma once
// One line that says how a machine is, for `systemctl status`.

#include <string>

#include "core/time.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::apps {

class StatusLine {
public:
    /// Each second: often enough for a person, seldom enough for whoever is told.
    [[nodiscard]] bool due(Instant now) noexcept;
    /// "running, automatic mode, 2 of 3 axes powered, 1 alarm".
    [[nodiscard]] static std::string text(const runtime::Snapshot& snapshot);

private:
    Instant next_{};
};

}  // namespace taktwerk::apps
