#pragma once
// The EtherCAT state machine as the firmware of a slave plays it: which transitions exist, what is checked before each, and
// which AL status code says no. Not for the cycle except fall_to_safeop(). Source: ETG.1000.6 (ESM), ETG.1020 (checks).

#include <cstdint>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "ecat/device_description.hpp"
#include "ecat/sim/coe_server.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/process_data.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

class AlStateMachine {
public:
    /// `coe` and `process_data` are null for slaves without mailbox.
    AlStateMachine(const DeviceDescription& description, SlaveController& controller, DeviceModel& model, CoeServer* coe,
                   ProcessData* process_data);

    void power_on(Instant now);
    /// The master wrote AL control.
    void request(std::uint16_t al_control, Instant now);
    /// OP -> SAFEOP with the error flag set, on the slave's own account (001Bh: SM watchdog).
    void fall_to_safeop(std::uint16_t code, Instant now);

    [[nodiscard]] EsmState state() const noexcept { return state_; }
    [[nodiscard]] bool error() const noexcept { return error_; }
    /// Process data is exchanged: SAFEOP and OP.
    [[nodiscard]] bool exchanging() const noexcept { return state_ == EsmState::safeop || state_ == EsmState::op; }
    [[nodiscard]] std::optional<unsigned> outputs_sm() const noexcept { return outputs_sm_; }
    [[nodiscard]] std::optional<unsigned> inputs_sm() const noexcept { return inputs_sm_; }

    /// Test: entering `to` from below fails with `code` until it is 0 again.
    void refuse_state(EsmState to, std::uint16_t code);

private:
    void move_to(EsmState to, Instant now);
    void refuse(std::uint16_t code);
    void show(std::uint16_t code);
    [[nodiscard]] std::uint16_t check_upwards(EsmState to);
    [[nodiscard]] std::uint16_t check_mailbox() const;
    [[nodiscard]] std::uint16_t check_process_data();
    [[nodiscard]] bool process_sm_fits(unsigned n, std::uint16_t bytes, std::uint16_t start, std::uint8_t direction) const;
    [[nodiscard]] std::uint16_t check_dc() const;
    [[nodiscard]] SyncSettings sync_settings() const;
    void lock_process_data(bool locked);

    const DeviceDescription& description_;
    SlaveController& controller_;
    DeviceModel& model_;
    CoeServer* coe_;
    ProcessData* process_data_;
    std::optional<unsigned> outputs_sm_, inputs_sm_;
    EsmState state_ = EsmState::init;
    bool error_ = false;
    struct Refusal {
        EsmState to;
        std::uint16_t code;
    };
    std::vector<Refusal> refusals_;
};

}  // namespace taktwerk::ecat::sim
