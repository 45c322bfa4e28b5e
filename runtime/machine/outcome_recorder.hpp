#pragma once
// What a cycle came to, into the recording (runtime/recording/outcome_record.hpp): set-points, output points, what serial drives are asked for, the
// outputs of the bus; each only when it is another one than before. Its memory is taken before the first cycle.

#include <cstddef>
#include <vector>

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"

namespace taktwerk::runtime {

class OutcomeRecorder {
public:
    OutcomeRecorder(MachineBody& body, MachineDrives& drives) : body_(body), drives_(drives) {}

    /// Before the first cycle, once somebody records.
    void begin();
    /// Cycle, real-time safe: before the frames leave. `armed`: axes and points are at work.
    void record(Instant at, bool armed) noexcept;

private:
    void record_if_new(RecordChannel channel, Instant at, std::span<const std::byte> bytes, std::vector<std::byte>& before) noexcept;

    MachineBody& body_;
    MachineDrives& drives_;
    std::vector<std::byte> now_;  // what is being put together
    std::vector<std::byte> setpoints_, points_, outputs_;
};

}  // namespace taktwerk::runtime
