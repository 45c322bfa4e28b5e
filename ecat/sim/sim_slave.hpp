#pragma once
// One simulated slave: the controller (hardware), the firmware on it (states, mailbox, process data) and the device model
// behind it. Made from a DeviceDescription; lives in machine time. Cyclic path allocation-free.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "ecat/description/device_description.hpp"
#include "ecat/sim/al_state_machine.hpp"
#include "ecat/sim/coe_server.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/ethernet_node.hpp"
#include "ecat/sim/foe_server.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/sim/process_data.hpp"
#include "ecat/sim/slave_controller.hpp"
#include "ecat/sim/slave_files.hpp"

namespace taktwerk::ecat::sim {

struct SlaveOptions {
    std::string name{};                                         ///< for messages; empty: the description's
    std::uint16_t alias = 0;                                    ///< SII word 4
    double drift_ppm = 0;                                       ///< of the DC quartz; positive: fast
    Duration clock_start{};                                     ///< local time at power-on
    bool lrw = true, bitwise_fmmu = true;                       ///< what its controller can (ControllerSettings)
    bool read_write = true;                                     ///< it executes APRW, FPRW and BRW
    std::optional<std::uint16_t> device_id{};                   ///< explicit device identification, as a rotary switch sets it
    Duration transition_time = std::chrono::microseconds{200};  ///< AL control written -> AL status changed
    Duration response_delay = std::chrono::microseconds{200};   ///< mailbox request taken -> answer ready
    Duration eeprom_read_time = std::chrono::microseconds{100};
    Duration eeprom_write_time = std::chrono::milliseconds{2};
    bool eeprom_reads_8_bytes = true;  ///< a read command delivers 8 bytes; else 4
    FirmwareOptions firmware{};        ///< of a slave with FoE
    EthernetOptions ethernet{};        ///< of a slave with EoE
};

class SimSlave {
public:
    SimSlave(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options);

    void power_on(Instant now);
    void power_off(Instant now);
    [[nodiscard]] bool powered() const noexcept { return powered_; }

    // --- for the network, real-time safe ------------------------------------------------------------------------------------
    /// A frame passes the processing unit at `at`.
    void process(std::span<MutableDatagram> datagrams, Instant at) noexcept;
    /// The frame is through. It left the master at `sent` and arrived at port p `arrival[p]` later where bit p of `arrives` is set.
    void frame_passed(Instant sent, std::span<const Duration, ports_per_slave> arrival, std::uint8_t arrives) noexcept {
        controller_.frame_passed(sent, arrival, arrives);
    }
    [[nodiscard]] Instant next_event() const noexcept { return next_event_; }
    /// Does what is due at `now`.
    void fire(Instant now) noexcept;
    /// Brings the device model to `now`.
    void settle(Instant now) noexcept;

    /// Which ports have a link: a bit each.
    void set_links(std::uint8_t links) noexcept;

    // --- for tests and for whoever plays with the machine ---------------------------------------------------------------------
    [[nodiscard]] EsmState state() const noexcept { return al_.state(); }
    [[nodiscard]] SlaveController& controller() noexcept { return controller_; }
    [[nodiscard]] const DeviceDescription& description() const noexcept { return *description_; }
    [[nodiscard]] DeviceModel& model() noexcept { return *model_; }
    /// Slaves without mailbox have an empty one.
    [[nodiscard]] ObjectDictionary& dictionary() noexcept { return dictionary_; }
    [[nodiscard]] const SlaveOptions& options() const noexcept { return options_; }
    /// nullptr: a slave without FoE. What is in them, and what of it runs, survives a power cut.
    [[nodiscard]] SlaveFiles* files() noexcept { return files_ ? &*files_ : nullptr; }
    [[nodiscard]] FoeServer* foe() noexcept { return foe_ ? &*foe_ : nullptr; }
    /// nullptr: a slave without EoE.
    [[nodiscard]] const EthernetNode* ethernet() const noexcept { return ethernet_ ? &*ethernet_ : nullptr; }
    /// The next mailbox answers claim a length that is not theirs.
    void answer_with_wrong_lengths(std::uint32_t answers) noexcept {
        if (coe_) coe_->misstate_lengths(answers);
    }
    /// From now on a mailbox request is answered so much later.
    void answer_after(Duration delay) noexcept {
        if (coe_) coe_->set_response_delay(delay);
    }
    /// Its firmware forgets to toggle: all segments of an SDO carry the bit of the first.
    void never_toggle() noexcept {
        if (coe_) coe_->never_toggle();
    }
    /// Every SDO to this object is aborted with `code` until it is 0 again.
    void abort_object(std::uint16_t index, std::uint8_t sub, std::uint32_t code) {
        if (coe_) coe_->abort_object(index, sub, code);
    }
    /// The firmware hangs: no state changes, no mailbox, no new inputs, outputs ignored; the controller goes on by itself. Until it is
    /// released, or the power goes.
    void hang(bool hung) noexcept;
    /// The mailbox neither takes nor answers anything until it is released.
    void stick_mailbox(bool stuck) noexcept;
    /// For masters that know no distributed clocks.
    void require_sync0(SyncRequirement requirement) noexcept { al_.require_sync0(requirement); }
    [[nodiscard]] bool runs_without_required_sync0() const noexcept { return description_->dc.required && !controller_.sync0_active(); }
    /// Entering `to` from below fails with this AL status code until it is 0 again.
    void refuse_state(EsmState to, std::uint16_t al_status_code) { al_.refuse_state(to, al_status_code); }
    /// Its application takes it from OP to SAFEOP with this AL status code.
    void leave_op(std::uint16_t al_status_code, Instant now);
    /// SYNC0 pulses in OP that found no new outputs.
    [[nodiscard]] std::uint32_t missed_outputs() const noexcept { return missed_outputs_; }

private:
    void handle_events(Instant now) noexcept;
    void exchange(Instant now) noexcept;
    void latch_raw_inputs() noexcept;
    void load_outputs() noexcept;
    void store_inputs() noexcept;
    void schedule() noexcept;
    void boot_application();
    void restart(Instant now);

    std::shared_ptr<const DeviceDescription> description_;
    std::unique_ptr<DeviceModel> model_;
    SlaveOptions options_;
    SlaveController controller_;
    ObjectDictionary dictionary_;
    ProcessData process_data_;
    std::optional<CoeServer> coe_;
    std::optional<SlaveFiles> files_;
    std::optional<FoeServer> foe_;
    std::optional<EthernetNode> ethernet_;
    AlStateMachine al_;
    Entry* missed_entry_ = nullptr;  // 1C32h:0Bh
    std::vector<std::byte> raw_;     // of a slave without dictionary, all its sync managers of one direction in a row
    bool powered_ = false;
    bool hung_ = false;
    std::optional<std::uint8_t> links_;  // known since power-on
    bool outputs_valid_ = false;         // outputs arrived since SAFEOP was entered
    Instant al_due_ = never;
    Instant ready_at_{};  // until then the application starts and asks for nothing
    Instant settled_{};
    Instant next_event_ = never;
    std::uint32_t missed_outputs_ = 0;
};

}  // namespace taktwerk::ecat::sim
