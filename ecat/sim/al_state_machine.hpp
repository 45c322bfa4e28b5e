#pragma once
// The EtherCAT state machine as the firmware of a slave plays it: which transitions exist, what is checked before each, and
// which AL status code says no. Not for the cycle except fall_to_safeop(). Source: ETG.1000.6 (ESM), ETG.1020 (checks).

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/sim/coe_server.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/process_data.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

/// `waived`: for masters without distributed clocks; the slave then exchanges when outputs arrive.
enum class SyncRequirement : std::uint8_t { as_described, waived };

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
    /// The sync managers of the description that carry process data, ascending.
    [[nodiscard]] std::span<const unsigned> outputs() const noexcept { return outputs_; }
    [[nodiscard]] std::span<const unsigned> inputs() const noexcept { return inputs_; }
    /// What the slave says when AL control bit 5 asks (a rotary switch); none: it has no explicit device identification.
    void set_device_id(std::optional<std::uint16_t> id) noexcept { device_id_ = id; }
    /// The master turned a sync manager on or off while the state needs it: INIT with 0016h for a mailbox, PREOP with 001Dh or
    /// 001Eh for process data.
    void check_running(Instant now);

    /// Why the slave is nothing but its boot loader (0014h: no valid firmware); 0: its application runs. Then only INIT and BOOT are left.
    void set_firmware_fault(std::uint16_t code) noexcept { firmware_fault_ = code; }

    /// Whether a slave whose description requires SYNC0 refuses SAFEOP without it (002Dh).
    void require_sync0(SyncRequirement requirement) noexcept { sync_requirement_ = requirement; }

    /// Test: entering `to` from below fails with `code` until it is 0 again.
    void refuse_state(EsmState to, std::uint16_t code);

private:
    void move_to(EsmState to, Instant now);
    void refuse(std::uint16_t code);
    void show(std::uint16_t code);
    [[nodiscard]] std::uint16_t check_upwards(EsmState to);
    [[nodiscard]] std::uint16_t check_mailbox(EsmState state) const;
    [[nodiscard]] std::uint16_t check_process_data();
    [[nodiscard]] std::uint16_t check_sync_managers() const;
    [[nodiscard]] std::uint16_t check_watchdog() const;
    [[nodiscard]] std::uint16_t bytes_of(unsigned n) const;
    [[nodiscard]] bool process_sm_fits(unsigned n, std::uint16_t bytes, std::uint16_t start, std::uint8_t direction) const;
    [[nodiscard]] std::uint16_t check_dc() const;
    [[nodiscard]] SyncSettings sync_settings() const;
    void lock_process_data(bool locked);
    [[nodiscard]] bool boots() const noexcept { return coe_ != nullptr && description_.mailbox->bootstrap.has_value(); }

    const DeviceDescription& description_;
    SlaveController& controller_;
    DeviceModel& model_;
    CoeServer* coe_;
    ProcessData* process_data_;
    std::vector<unsigned> outputs_, inputs_;
    std::uint16_t firmware_fault_ = 0;
    std::optional<std::uint16_t> device_id_;
    bool id_requested_ = false;
    EsmState state_ = EsmState::init;
    bool error_ = false;
    SyncRequirement sync_requirement_ = SyncRequirement::as_described;
    struct Refusal {
        EsmState to;
        std::uint16_t code;
    };
    std::vector<Refusal> refusals_;
};

}  // namespace taktwerk::ecat::sim
