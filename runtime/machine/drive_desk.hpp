#pragma once
// What people ask drives of the bus while the machine runs (parameters, services of a drive), where a run is recorded: each request at its place
// among the services of the bus, and its answer taken there as well, whether somebody waits for it or not. Else the ports are asked directly.
// Service side, not real-time.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "axes/port/drive_port.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"
#include "runtime/recording/asked_record.hpp"

namespace taktwerk::runtime {

class DriveDesk {
public:
    DriveDesk(MachineBody& body, MachineDrives& drives) : body_(body), drives_(drives) {}
    DriveDesk(const DriveDesk&) = delete;
    DriveDesk& operator=(const DriveDesk&) = delete;

    /// For callers from outside. Lives as long as the machine.
    [[nodiscard]] axes::DrivePort& port(std::size_t axis);

    /// What was asked since the last time, into the recording; before the drives' services.
    void note(Instant now);
    /// Answers that have come; behind the drives' services.
    void collect();
    /// A request of a recording. False: this machine cannot have had it.
    [[nodiscard]] bool ask_again(const AskedRecord& asked);

private:
    class Port;
    static constexpr std::size_t most_answers = 64;  ///< nobody waits for more; the oldest go
    struct Flight {
        std::size_t axis = 0;
        axes::ServiceTicket ticket = 0;
    };
    [[nodiscard]] axes::ServiceTicket ask(const AskedRecord& asked);
    [[nodiscard]] std::optional<Result<axes::ServiceAnswer>> answer(std::size_t axis, axes::ServiceTicket ticket);

    MachineBody& body_;
    MachineDrives& drives_;
    std::vector<std::unique_ptr<axes::DrivePort>> ports_;  // per axis, once one is wanted
    std::vector<AskedRecord> asked_;
    std::vector<Flight> flights_;
    std::deque<std::pair<Flight, Result<axes::ServiceAnswer>>> answers_;
};

}  // namespace taktwerk::runtime
