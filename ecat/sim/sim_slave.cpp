#include "ecat/sim/sim_slave.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/bytes.hpp"
#include "ecat/description/module_pdos.hpp"
#include "ecat/sim/sii_image.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::uint16_t no_valid_firmware = 0x0014, sm_watchdog_expired = 0x001B;

ControllerSettings settings_of(const DeviceDescription& description, const SlaveOptions& options) {
    ControllerSettings settings;
    settings.fmmus = std::min<std::uint8_t>(description.fmmus, 16);
    settings.sync_managers = std::min<std::uint8_t>(description.sync_manager_count, 16);
    settings.process_ram = description.process_ram;
    settings.dc = description.dc.supported;
    settings.dc_64bit = description.dc.clock_64bit;
    settings.lrw = options.lrw;
    settings.read_write = options.read_write;
    settings.bitwise_fmmu = options.bitwise_fmmu;
    settings.application = description.mailbox.has_value();
    // Who takes a current from the E-bus is on it with all ports; who supplies it has its cable from the master in an RJ45.
    constexpr std::uint8_t all_ports = 0b1111, all_but_in = 0b1110;
    if (description.ebus_current) settings.ebus = *description.ebus_current < 0 ? all_but_in : all_ports;
    return settings;
}

std::uint8_t general_flags(const SlaveOptions& options) {
    constexpr unsigned lrw_not_supported = 1u << 1, identifies_in_al_status = 1u << 3;  // ETG.2010, category General
    return static_cast<std::uint8_t>((options.lrw ? 0u : lrw_not_supported) | (options.device_id ? identifies_in_al_status : 0u));
}

/// A slave without CoE has no dictionary: nothing but what a description always implies would be in it.
DeviceDescription dictionary_source(const DeviceDescription& description) {
    return description.mailbox && description.mailbox->coe ? description : DeviceDescription{};
}

}  // namespace

SimSlave::SimSlave(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options)
    : description_(description->slots.count == 0 ? std::move(description)
                                                 : std::make_shared<const DeviceDescription>(with_slots_filled(*description))),
      model_(std::move(model)),
      options_(std::move(options)),
      controller_(settings_of(*description_, options_),
                  EepromInterface{sii_image(*description_, options_.alias, general_flags(options_)), options_.eeprom_read_time,
                                  options_.eeprom_write_time, options_.eeprom_reads_8_bytes}),
      dictionary_(dictionary_source(*description_)),
      process_data_(*description_, dictionary_),
      al_(*description_, controller_, *model_,
          description_->mailbox ? &coe_.emplace(*description_, dictionary_, *model_, controller_, options_.response_delay) : nullptr,
          description_->mailbox ? &process_data_ : nullptr) {
    if (options_.name.empty()) options_.name = description_->name;
    model_->connect(coe_ ? &*coe_ : nullptr);
    if (coe_ && description_->mailbox->foe) {
        foe_.emplace(files_.emplace(description_->identity, options_.firmware));
        coe_->attach(MailboxType::foe, *foe_);
    }
    if (coe_ && description_->mailbox->eoe) coe_->attach(MailboxType::eoe, ethernet_.emplace(options_.ethernet));
    missed_entry_ = dictionary_.find(0x1C32, 0x0B);
    al_.set_device_id(options_.device_id);
    raw_.resize(description_->process_ram);
}

void SimSlave::power_on(Instant now) {
    controller_.power_on(now, options_.clock_start.count(), static_cast<std::int32_t>(std::lround(options_.drift_ppm * 1000.0)));
    dictionary_.reset();
    powered_ = true;
    hung_ = outputs_valid_ = false;
    links_.reset();
    al_due_ = never;
    settled_ = now;
    missed_outputs_ = 0;
    ready_at_ = now;
    if (files_) boot_application();
    model_->power_on(dictionary_, now);
    al_.power_on(now);
    schedule();
}

/// What the boot loader finds sound says who the device is; where it finds nothing only the way to BOOT is left.
void SimSlave::boot_application() {
    files_->flash().boot();
    const auto& running = files_->flash().running();
    al_.set_firmware_fault(running ? std::uint16_t{0} : no_valid_firmware);
    if (!running) return;
    const std::uint32_t revision = running->identity.revision;
    auto& eeprom = controller_.eeprom().image();
    constexpr std::size_t revision_at = std::size_t{2} * sii_word::revision;
    if (eeprom.size() >= revision_at + sizeof revision) store_le(std::span{eeprom}, revision_at, revision);
    if (Entry* entry = dictionary_.find(0x1018, 3)) entry->set(revision);
    if (Entry* entry = dictionary_.find(0x100A, 0); entry != nullptr && entry->type() == DataType::STRING)
        entry->set_text(running->version);
}

/// BOOT was left: from here on the boot loader decides.
void SimSlave::restart(Instant now) {
    power_off(now);
    power_on(now);
    ready_at_ = now + options_.firmware.restart_time;
}

void SimSlave::set_links(std::uint8_t links) noexcept {
    const bool changed = links_ && *links_ != links;
    links_ = links;
    controller_.set_links(links);
    if (changed && !hung_ && al_.state() != EsmState::init) model_->link_changed(settled_);
}

void SimSlave::power_off(Instant now) {
    if (!powered_) return;
    settle(now);
    powered_ = false;
    next_event_ = never;
    model_->power_off(now);
}

void SimSlave::leave_op(std::uint16_t al_status_code, Instant now) {
    settle(now);
    al_.fall_to_safeop(al_status_code, now);
    schedule();
}

void SimSlave::process(std::span<MutableDatagram> datagrams, Instant at) noexcept {
    while (next_event_ <= at) fire(next_event_);
    controller_.begin_frame();
    // Plain inputs are sampled at the start of the frame that carries them away.
    if (!description_->mailbox && al_.exchanging()) latch_raw_inputs();
    for (auto& datagram : datagrams) controller_.execute(datagram, at);
    handle_events(at);
    schedule();
}

void SimSlave::fire(Instant now) noexcept {
    controller_.fire(now);
    if (hung_) return schedule();
    if (al_due_ <= now) {
        al_due_ = never;
        settle(now);
        const bool exchanged = al_.exchanging(), was_in_boot = al_.state() == EsmState::boot;
        al_.request(controller_.take_al_control(), now);
        if (was_in_boot && al_.state() == EsmState::init && files_) return restart(now);
        if (!exchanged && al_.exchanging()) {
            outputs_valid_ = false;
            if (Entry* cycle = dictionary_.find(0x1C32, 0x02); cycle != nullptr && controller_.sync0_runs())
                cycle->set(controller_.sync0().cycle().count());
            exchange(now);  // the inputs are valid from the first frame in SAFEOP on
        }
    }
    if (coe_ && coe_->next_event() <= now) {
        settle(now);
        if (!al_.exchanging()) model_->exchange(now);  // an SDO sees the present in PREOP, too
        coe_->step(al_.state(), now);
    }
    handle_events(now);
    schedule();
}

void SimSlave::handle_events(Instant now) noexcept {
    if (hung_) return;
    const unsigned events = controller_.take_events();
    if (events == 0) return;
    if ((events & event::reset) != 0) {
        power_off(now);
        return power_on(now);
    }
    if ((events & event::al_control) != 0 && al_due_ == never) al_due_ = std::max(now, ready_at_) + options_.transition_time;
    if ((events & event::sync_manager_switched) != 0) al_.check_running(now);
    if (coe_ && (events & (event::mailbox_written | event::mailbox_read | event::repeat_request)) != 0) coe_->step(al_.state(), now);
    if ((events & event::watchdog) != 0 && al_.state() == EsmState::op) {
        settle(now);
        for (const unsigned n : al_.outputs()) controller_.clear_outputs(n);
        outputs_valid_ = false;
        model_->outputs_lost(now);
        al_.fall_to_safeop(sm_watchdog_expired, now);
    }
    if (!al_.exchanging()) return;
    // A terminal may have a sync manager for outputs and none to receive: its inputs go by their own event then.
    const bool receives = std::ranges::any_of(al_.outputs(), [this](unsigned n) { return !coe_ || process_data_.bytes(n) > 0; });
    if (controller_.sync0_runs()) {
        if ((events & event::sync0) != 0) exchange(now);
    } else if ((events & (receives ? event::outputs : event::inputs_read)) != 0) {
        exchange(now);
    }
}

void SimSlave::exchange(Instant now) noexcept {
    settle(now);
    bool fresh = false;
    for (const unsigned n : al_.outputs()) fresh |= controller_.take_fresh(n);
    outputs_valid_ |= fresh;
    const bool op = al_.state() == EsmState::op;
    if (op && !al_.outputs().empty() && !fresh && controller_.sync0_runs()) {
        ++missed_outputs_;
        if (missed_entry_ != nullptr) missed_entry_->set(std::min<std::int64_t>(missed_outputs_, 0xFFFF));
    }
    if (op && outputs_valid_) load_outputs();
    if (op) model_->exchange_due({.outputs = fresh, .sync0 = controller_.sync0_runs()});
    model_->exchange(now);
    if (description_->mailbox) store_inputs();
    else latch_raw_inputs();
}

void SimSlave::load_outputs() noexcept {
    if (description_->mailbox) {
        for (const unsigned n : al_.outputs()) process_data_.load_outputs(n, controller_.outputs(n));
        return;
    }
    std::size_t size = 0;
    for (const unsigned n : al_.outputs()) {
        const auto part = controller_.outputs(n);
        const std::size_t run = std::min(part.size(), raw_.size() - size);
        std::copy_n(part.begin(), run, raw_.begin() + static_cast<std::ptrdiff_t>(size));
        size += run;
    }
    if (size > 0) model_->raw_outputs({raw_.data(), size});
}

void SimSlave::store_inputs() noexcept {
    for (const unsigned n : al_.inputs()) {
        process_data_.store_inputs(n, controller_.inputs(n));
        controller_.publish_inputs(n);
    }
}

void SimSlave::latch_raw_inputs() noexcept {
    std::size_t size = 0;
    for (const unsigned n : al_.inputs()) size += controller_.inputs(n).size();
    if (size == 0 || size > raw_.size()) return;
    model_->raw_inputs({raw_.data(), size});
    std::size_t from = 0;
    for (const unsigned n : al_.inputs()) {
        const auto part = controller_.inputs(n);
        std::copy_n(raw_.begin() + static_cast<std::ptrdiff_t>(from), part.size(), part.begin());
        from += part.size();
        controller_.publish_inputs(n);
    }
}

void SimSlave::hang(bool hung) noexcept {
    if (!powered_ || hung_ == hung) return;
    hung_ = hung;
    controller_.set_application_alive(!hung, settled_);
    if (!hung) handle_events(settled_);  // what came in meanwhile
    schedule();
}

void SimSlave::settle(Instant now) noexcept {
    if (now <= settled_) return;
    settled_ = now;
    model_->advance(now);
}

void SimSlave::stick_mailbox(bool stuck) noexcept {
    if (!coe_) return;
    coe_->stick(stuck);
    if (powered_) coe_->step(al_.state(), settled_);  // what waited goes on from here
    schedule();
}

void SimSlave::schedule() noexcept {
    next_event_ = controller_.next_event();
    if (hung_) return;
    next_event_ = std::min(next_event_, al_due_);
    if (coe_) next_event_ = std::min(next_event_, coe_->next_event());
}

}  // namespace taktwerk::ecat::sim
