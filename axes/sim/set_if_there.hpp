#pragma once

#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

/// For objects that a drive may do without. Real-time safe.
inline void set_if_there(ecat::sim::Entry* entry, std::int64_t value) noexcept {
    if (entry) entry->set(value);
}

}  // namespace taktwerk::axes::sim
