#pragma once
// The alarms a drive remembers, with what it was doing: ten of them, an alarm that is among the last five only once.
// Source: SV33-E manual 5.1 and 7.2 (P21.30 to P21.35). Plain data, fixed size; it outlives resets and power cycles.

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes::sim {

class AlarmHistory {
public:
    struct Record {
        std::uint32_t shown = 0;  ///< as the drive shows an alarm (P21.08); 0: no such record
        Duration since_power_on{};
        double speed = 0;  ///< counts/s
    };
    static constexpr std::size_t length = 10, looked_back = 5;

    void remember(const Record& record) noexcept {
        for (std::size_t i = 0; i < looked_back; ++i)
            if (records_[i].shown == record.shown) return;
        for (std::size_t i = length - 1; i > 0; --i) records_[i] = records_[i - 1];
        records_[0] = record;
    }
    /// 0 is the latest; a record whose `shown` is 0 beyond the last.
    [[nodiscard]] Record latest(std::size_t n) const noexcept { return n < length ? records_[n] : Record{}; }

private:
    std::array<Record, length> records_{};
};

}  // namespace taktwerk::axes::sim
