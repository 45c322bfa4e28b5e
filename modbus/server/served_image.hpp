#pragma once
// What the machine said of its registers after one cycle: they are of the same instant, so what is read together belongs together.

#include <cstdint>
#include <vector>

#include "core/time.hpp"
#include "modbus/server/register_words.hpp"

namespace taktwerk::modbus::server {

struct ServedImage {
    bool ever = false;                 ///< false: nothing was said yet
    Instant at{};                      ///< of that cycle
    std::vector<RegisterWords> words;  ///< one per register of the map, in its order

    /// Older than that it is no answer any more.
    [[nodiscard]] bool fresh(Instant now, Duration max_age) const noexcept { return ever && now - at <= max_age; }
};

}  // namespace taktwerk::modbus::server
