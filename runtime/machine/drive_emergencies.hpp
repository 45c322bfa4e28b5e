#pragma once
// Emergencies of drives. A drive's emergency repeats by its number what its axis says in the words of the drive's manual: it is an alarm of its
// own only where no axis tells it. Real-time safe.

#include <vector>

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"

namespace taktwerk::runtime {

class DriveEmergencies {
public:
    DriveEmergencies(MachineBody& body, const MachineDrives& drives) : body_(body), drives_(drives), of_slaves_(body.bus.slave_count()) {}

    /// Once a cycle, with what the bus says: told_by_an_axis() for each emergency in between.
    void begin_cycle() noexcept;
    /// Keeps what a slave sent; true where it is no alarm of its own (yet).
    [[nodiscard]] bool told_by_an_axis(const AlarmFact& emergency) noexcept;
    /// Raises those that came and went with nobody telling them.
    void end_cycle() noexcept;

private:
    struct OfSlave {
        AlarmFact fact{};  // a is its code; 0: none
        Instant since{};
        bool told = false;      // its axis has shown the same code meanwhile
        bool raised = false;    // it has been an alarm of its own
        bool seen = false;      // in this cycle
        AlarmFact missed{};     // one that was over before anybody had told it ...
        Instant shown_until{};  // ... is an alarm until then
    };
    void miss(OfSlave& last) noexcept;
    /// Notes whether an axis of that slave shows the same; false where it has none.
    bool axis_tells(OfSlave& last) noexcept;

    MachineBody& body_;
    const MachineDrives& drives_;
    std::vector<OfSlave> of_slaves_;
};

}  // namespace taktwerk::runtime
