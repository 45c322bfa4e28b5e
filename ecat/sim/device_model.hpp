#pragma once
// What a simulated slave does behind its slave controller. The controller (registers, SII, FMMU, SM, AL, mailbox, DC) and
// the CoE server live in ecat/sim/; a drive or terminal plugs in here. Drive models live in axes/sim/.

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/time.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat::sim {

class ObjectDictionary;  // ecat/sim/object_dictionary.hpp: entries with live values, addressed by (index, sub)

/// Bits of AL status (0130h).
enum class EsmState : std::uint8_t { init = 1, preop = 2, boot = 3, safeop = 4, op = 8 };

/// What the controller tells the application when a state is asked for.
struct SyncSettings {
    bool sync0_active = false;
    Duration sync0_cycle{};
    std::uint16_t output_bytes = 0, input_bytes = 0;
};

/// What brings an exchange of process data about.
struct ExchangeCause {
    bool outputs = false;  ///< new ones came since the last exchange: a frame may be late or lost
    bool sync0 = false;    ///< SYNC0 fired
};

/// Where an application puts its emergencies: the mailbox sends them as soon as it is free.
class EmergencyPort {
public:
    virtual void send(const Emergency& emergency) noexcept = 0;

protected:
    ~EmergencyPort() = default;
};

class DeviceModel {
public:
    virtual ~DeviceModel() = default;

    /// Before the first power_on(). `port` outlives the model's last call; null: a slave without CoE.
    void connect(EmergencyPort* port) noexcept { emergencies_ = port; }

    /// Power is on: dictionary values are at their defaults (or what non-volatile memory holds). Resolve objects here.
    virtual void power_on(ObjectDictionary& dictionary, Instant now) = 0;

    /// The control supply is gone: no more exchange() until the next power_on(); advance() goes on (a motor coasts).
    virtual void power_off(Instant now) { (void)now; }

    /// AL status code with which the application refuses the transition; 0 accepts. The controller has checked SM settings.
    virtual std::uint16_t refuse(EsmState from, EsmState to, const SyncSettings& settings) {
        (void)from, (void)to, (void)settings;
        return 0;
    }
    virtual void entered(EsmState state, Instant now) { (void)state, (void)now; }

    /// Process data is due: the mapped RxPDO objects hold the newest outputs; after return the TxPDO objects are copied to
    /// the inputs. Called at SYNC0 when it runs, else when outputs arrive. Allocation-free.
    virtual void exchange(Instant now) = 0;

    /// Before each exchange() in OP.
    virtual void exchange_due(const ExchangeCause& cause) { (void)cause; }

    /// Physical time passes up to `now` (also between exchanges; never backwards). Allocation-free.
    virtual void advance(Instant now) { (void)now; }

    /// A network port lost or found its link, in PREOP or above.
    virtual void link_changed(Instant now) { (void)now; }

    /// The SM watchdog expired in OP: the controller goes to SAFEOP with 001Bh.
    virtual void outputs_lost(Instant now) { (void)now; }

    /// An SDO wants to write (range, access and type are checked). Abort code, 0 accepts; `written` follows.
    virtual std::uint32_t refuse_write(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
        (void)index, (void)sub, (void)value;
        return 0;
    }
    virtual void written(std::uint16_t index, std::uint8_t sub, Instant now) { (void)index, (void)sub, (void)now; }

    /// Terminals without CoE: raw process data instead of objects. Called around exchange().
    virtual void raw_outputs(std::span<const std::byte> outputs) { (void)outputs; }
    virtual void raw_inputs(std::span<std::byte> inputs) { (void)inputs; }

protected:
    /// Tells the master about an error (code 0000h: it is gone). From any call above; dropped in INIT and without CoE.
    void send_emergency(const Emergency& emergency) noexcept {
        if (emergencies_ != nullptr) emergencies_->send(emergency);
    }

private:
    EmergencyPort* emergencies_ = nullptr;
};

}  // namespace taktwerk::ecat::sim
