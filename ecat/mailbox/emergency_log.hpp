#pragma once
// Emergencies of a bus: what slaves sent unasked, in the order in which it was read. Service side.

#include <cstddef>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat {

struct SlaveEmergency {
    std::size_t slave = 0;  ///< in configuration order
    Instant at{};           ///< machine time at which it was read out of the mailbox
    Emergency emergency;
};

/// Bounded: the newest `limit` are kept, oldest first.
class EmergencyLog {
public:
    static constexpr std::size_t limit = 100;

    void keep(const SlaveEmergency& emergency) {
        if (entries_.size() >= limit) entries_.erase(entries_.begin());
        entries_.push_back(emergency);
        ++count_;
    }
    [[nodiscard]] std::span<const SlaveEmergency> entries() const noexcept { return entries_; }
    /// All that ever came, also those that are no longer kept.
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

private:
    std::vector<SlaveEmergency> entries_;
    std::size_t count_ = 0;
};

}  // namespace taktwerk::ecat
