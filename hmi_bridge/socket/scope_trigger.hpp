#pragma once
// The triggers of the scope: one for each connection, looked for on the service side. README.md has the requests. One thread.

#include <map>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "hmi_bridge/line_handler.hpp"
#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/socket/json_fields.hpp"
#include "runtime/new_alarms.hpp"
#include "runtime/recording/trigger.hpp"

namespace taktwerk::hmi {

class ScopeTrigger {
public:
    static constexpr std::size_t rows_per_step = 4096;  ///< of one trigger: four seconds of a usual machine

    /// `machine` and its signals() outlive this.
    explicit ScopeTrigger(const MachineLink& machine) : machine_(machine) {}

    /// In place of the one that this connection has. Errors: request..., scope.unknown_signal, scope.condition.
    [[nodiscard]] Result<void> arm(ConnectionId connection, JsonFields& fields);
    void disarm(ConnectionId connection) { hunts_.erase(connection); }
    /// {"armed":...,"looked_to":...,"skipped":...,"events":[...]}
    [[nodiscard]] std::string state_json(ConnectionId connection) const;
    /// `snapshot`: the newest, nullptr before the first.
    void step(const runtime::Snapshot* snapshot);

private:
    struct Armed {
        runtime::TriggerHunt hunt;
        std::string alarm;  ///< its name; empty: each that stops something
    };

    const MachineLink& machine_;
    std::map<ConnectionId, Armed> hunts_;
    runtime::NewAlarms alarms_;
};

}  // namespace taktwerk::hmi
