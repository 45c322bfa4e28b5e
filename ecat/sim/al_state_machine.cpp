#include "ecat/sim/al_state_machine.hpp"

#include <algorithm>

#include "ecat/wire/al_status.hpp"

namespace taktwerk::ecat::sim {

namespace {

// AL status codes (ETG.1000.6 table 11; texts in ecat/wire/al_status.cpp).
constexpr std::uint16_t invalid_state_change = 0x0011, unknown_state = 0x0012, no_bootstrap = 0x0013;
constexpr std::uint16_t invalid_boot_mailbox = 0x0015, invalid_mailbox = 0x0016;
constexpr std::uint16_t invalid_sync_manager = 0x0017, invalid_outputs = 0x001D, invalid_inputs = 0x001E, invalid_watchdog = 0x001F;
constexpr std::uint16_t no_sync = 0x002D, invalid_sync0_cycle = 0x0036;

int rank(EsmState state) noexcept {
    switch (state) {
        case EsmState::init: return 0;
        case EsmState::boot:
        case EsmState::preop: return 1;
        case EsmState::safeop: return 2;
        case EsmState::op: return 3;
    }
    return 0;
}

std::vector<unsigned> all_of(const DeviceDescription& description, SmUse use) {
    std::vector<unsigned> found;
    for (unsigned n = 0; n < description.sync_managers.size(); ++n)
        if (description.sync_managers[n].use == use) found.push_back(n);
    return found;
}

}  // namespace

AlStateMachine::AlStateMachine(const DeviceDescription& description, SlaveController& controller, DeviceModel& model, CoeServer* coe,
                               ProcessData* process_data)
    : description_(description),
      controller_(controller),
      model_(model),
      coe_(coe),
      process_data_(process_data),
      outputs_(all_of(description, SmUse::outputs)),
      inputs_(all_of(description, SmUse::inputs)) {}

void AlStateMachine::power_on(Instant now) {
    state_ = EsmState::init;
    error_ = id_requested_ = false;
    if (coe_ != nullptr) coe_->stop();
    lock_process_data(true);
    show(0);
    model_.entered(state_, now);
}

void AlStateMachine::refuse_state(EsmState to, std::uint16_t code) {
    refusals_.erase(std::remove_if(refusals_.begin(), refusals_.end(), [&](const Refusal& r) { return r.to == to; }), refusals_.end());
    if (code != 0) refusals_.push_back({to, code});
}

void AlStateMachine::show(std::uint16_t code) {
    unsigned status = static_cast<unsigned>(state_) | (error_ ? al_status_error : 0u);
    // The id takes the place of the code, so an error hides it.
    if (id_requested_ && device_id_ && !error_) {
        status |= al_status_id_valid;
        code = *device_id_;
    }
    controller_.set_al_status(static_cast<std::uint16_t>(status), code);
}

void AlStateMachine::refuse(std::uint16_t code) {
    error_ = true;
    show(code);
}

void AlStateMachine::request(std::uint16_t al_control, Instant now) {
    const auto wanted = al_state(al_control);
    id_requested_ = (al_control & al_control_request_id) != 0;
    if (error_) {
        // Until the master has acknowledged, only the way to INIT is open.
        if ((al_control & al_control_acknowledge) == 0 && wanted != AlState::init) return;
        error_ = false;
        show(0);
    }
    if (wanted == AlState::unknown) return refuse(unknown_state);
    if (wanted == AlState::boot && !boots()) return refuse(no_bootstrap);
    const auto to = static_cast<EsmState>(wanted);
    if (to == state_) return show(0);
    // Between BOOT and everything else lies INIT.
    const bool to_or_from_boot = to == EsmState::boot || state_ == EsmState::boot;
    if (to_or_from_boot && to != EsmState::init && state_ != EsmState::init) return refuse(invalid_state_change);
    if (rank(to) < rank(state_)) return move_to(to, now);
    if (rank(to) > rank(state_) + 1) return refuse(invalid_state_change);
    if (const auto code = check_upwards(to); code != 0) return refuse(code);
    move_to(to, now);
}

void AlStateMachine::fall_to_safeop(std::uint16_t code, Instant now) {
    if (state_ != EsmState::op) return;
    error_ = true;
    state_ = EsmState::safeop;
    show(code);
    model_.entered(state_, now);
}

void AlStateMachine::move_to(EsmState to, Instant now) {
    const EsmState from = state_;
    state_ = to;
    if (from == EsmState::init && coe_ != nullptr) {
        // Whatever was written to the mailboxes before nobody will read.
        controller_.lock_sync_manager(coe_->out_sm(), false);
        controller_.lock_sync_manager(coe_->in_sm(), false);
        coe_->start(to);
    }
    if (rank(to) <= 1) lock_process_data(true);
    if (from == EsmState::preop && to == EsmState::safeop) lock_process_data(false);
    if (to == EsmState::op && controller_.watchdog_configured()) controller_.start_watchdog(now);
    if (from == EsmState::op) controller_.stop_watchdog();
    if (to == EsmState::init && coe_ != nullptr) coe_->stop();
    show(0);
    model_.entered(to, now);
}

void AlStateMachine::lock_process_data(bool locked) {
    for (const unsigned n : outputs_) controller_.lock_sync_manager(n, locked);
    for (const unsigned n : inputs_) controller_.lock_sync_manager(n, locked);
}

void AlStateMachine::check_running(Instant now) {
    if (error_ || state_ == EsmState::init) return;
    const auto fall = [&](EsmState to, std::uint16_t code) {
        move_to(to, now);
        refuse(code);
    };
    if (const auto code = coe_ != nullptr ? check_mailbox(state_) : std::uint16_t{0}; code != 0) return fall(EsmState::init, code);
    if (!exchanging()) return;
    if (const auto code = check_sync_managers(); code != 0) fall(EsmState::preop, code);
}

std::uint16_t AlStateMachine::check_upwards(EsmState to) {
    std::uint16_t code = 0;
    if (coe_ != nullptr) code = check_mailbox(to);
    if (code == 0 && to == EsmState::boot) return model_.refuse(state_, to, {});
    if (code == 0) code = firmware_fault_;
    if (code == 0 && to == EsmState::safeop) code = check_process_data();
    if (code == 0 && to == EsmState::op) code = check_sync_managers();
    if (code == 0 && to != EsmState::preop) code = check_watchdog();
    if (code == 0 && to != EsmState::preop) code = check_dc();
    if (code != 0) return code;
    for (const auto& refusal : refusals_)
        if (refusal.to == to) return refusal.code;
    return model_.refuse(state_, to, sync_settings());
}

std::uint16_t AlStateMachine::check_mailbox(EsmState state) const {
    const auto good = [&](unsigned n, std::uint8_t direction, std::uint16_t start, std::uint16_t size) {
        if (n >= description_.sync_managers.size()) return false;
        const SyncManager& sm = controller_.sync_manager(n);
        return sm.enabled() && sm.is_mailbox() && (sm.control & SyncManager::direction_mask) == direction && sm.start == start &&
               sm.length == size;
    };
    const auto described = [&](unsigned n, std::uint8_t direction) {
        return n < description_.sync_managers.size() &&
               good(n, direction, description_.sync_managers[n].start, description_.sync_managers[n].size);
    };
    if (state == EsmState::boot) {
        const auto& boot = *description_.mailbox->bootstrap;
        const bool fits = good(coe_->out_sm(), SyncManager::master_writes, boot.out_start, boot.out_size) &&
                          good(coe_->in_sm(), 0, boot.in_start, boot.in_size);
        return fits ? std::uint16_t{0} : invalid_boot_mailbox;
    }
    return described(coe_->out_sm(), SyncManager::master_writes) && described(coe_->in_sm(), 0) ? std::uint16_t{0} : invalid_mailbox;
}

std::uint16_t AlStateMachine::check_process_data() {
    if (process_data_ != nullptr)
        if (const auto code = process_data_->resolve(); code != 0) return code;
    return check_sync_managers();
}

std::uint16_t AlStateMachine::bytes_of(unsigned n) const {
    return process_data_ != nullptr ? process_data_->bytes(n) : description_.sync_managers[n].size;
}

std::uint16_t AlStateMachine::check_sync_managers() const {
    const auto fits = [&](unsigned n, std::uint8_t direction) {
        return process_sm_fits(n, bytes_of(n), description_.sync_managers[n].start, direction);
    };
    for (const unsigned n : outputs_)
        if (!fits(n, SyncManager::master_writes)) return invalid_outputs;
    for (const unsigned n : inputs_)
        if (!fits(n, 0)) return invalid_inputs;
    // One that the device does not know would take memory from it.
    for (auto n = static_cast<unsigned>(description_.sync_managers.size()); n < controller_.settings().sync_managers; ++n)
        if (controller_.sync_manager(n).enabled() && controller_.sync_manager(n).length > 0) return invalid_sync_manager;
    return 0;
}

std::uint16_t AlStateMachine::check_watchdog() const {
    // Outputs that the device wants supervised must trigger the watchdog. (Its time may be 0: the master's explicit choice.)
    for (const unsigned n : outputs_) {
        const bool wanted = (description_.sync_managers[n].control & SyncManager::watchdog_trigger) != 0;
        const SyncManager& sm = controller_.sync_manager(n);
        if (wanted && sm.enabled() && sm.length > 0 && (sm.control & SyncManager::watchdog_trigger) == 0) return invalid_watchdog;
    }
    return 0;
}

bool AlStateMachine::process_sm_fits(unsigned n, std::uint16_t bytes, std::uint16_t start, std::uint8_t direction) const {
    const SyncManager& sm = controller_.sync_manager(n);
    if (bytes == 0) return !sm.enabled() || sm.length == 0;
    if (!sm.enabled() || sm.length != bytes) return false;
    if ((sm.control & SyncManager::mode_mask) != SyncManager::mode_buffered || (sm.control & SyncManager::direction_mask) != direction)
        return false;
    if (start != 0 && sm.start != start) return false;
    // Three buffers lie one after the other; only slaves with an application use all of them.
    const unsigned buffers = description_.mailbox ? 3 : 1;
    const auto area_end = [&](const SyncManager& m, unsigned copies) { return std::uint32_t{m.start} + std::uint32_t{m.length} * copies; };
    if (!holds_process_data(sm.start, sm.length) || area_end(sm, buffers) > std::uint32_t{reg::process_ram} + description_.process_ram)
        return false;
    for (unsigned other = 0; other < controller_.settings().sync_managers; ++other) {
        const SyncManager& m = controller_.sync_manager(other);
        if (other == n || !m.enabled() || m.length == 0) continue;
        if (m.start < area_end(sm, buffers) && sm.start < area_end(m, m.is_mailbox() ? 1 : buffers)) return false;
    }
    return true;
}

std::uint16_t AlStateMachine::check_dc() const {
    const Sync0& sync0 = controller_.sync0();
    const bool required = description_.dc.required && sync_requirement_ == SyncRequirement::as_described;
    if (!controller_.sync0_active()) return required ? no_sync : std::uint16_t{0};
    if (!sync0.runs()) return no_sync;  // the start time was in the past, or there is no cycle: no pulse will come
    const Duration cycle = sync0.cycle();
    const DcDescription& dc = description_.dc;
    if (cycle < dc.minimum_cycle) return invalid_sync0_cycle;
    if (dc.cycle_multiple > Duration::zero() && cycle % dc.cycle_multiple != Duration::zero()) return invalid_sync0_cycle;
    if (!dc.cycles.empty() && std::find(dc.cycles.begin(), dc.cycles.end(), cycle) == dc.cycles.end()) return invalid_sync0_cycle;
    return 0;
}

SyncSettings AlStateMachine::sync_settings() const {
    SyncSettings settings;
    settings.sync0_active = controller_.sync0_runs();
    settings.sync0_cycle = controller_.sync0().cycle();
    for (const unsigned n : outputs_) settings.output_bytes = static_cast<std::uint16_t>(settings.output_bytes + bytes_of(n));
    for (const unsigned n : inputs_) settings.input_bytes = static_cast<std::uint16_t>(settings.input_bytes + bytes_of(n));
    return settings;
}

}  // namespace taktwerk::ecat::sim
