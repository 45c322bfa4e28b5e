#pragma once
// The EtherCAT master as the floors above see it: a cyclic side (real-time) and a service side (everything acyclic).
//
//   service side   step(now): bring-up, recovery, SDO as resumable scripts. One thread, not real-time.
//   cyclic side    receive(now) / send(now): process data, then at most K acyclic datagrams. Real-time safe.
//   before cycles  pump(now): moves acyclic datagrams only; for whoever has no cycle running yet.
//
// In virtual time the same three are called in a fixed order from one thread. Source: ETG.1000, docs/architecture.md.
//
// Time. The bus' system time (DC) starts as machine time; the reference clock, the first slave with DC, then runs by itself.
// Each cycle's FRMW answer tells how far the two are apart (BusStatistics::dc_offset_ns, dc_drift_ppb); SYNC0 instants and latch
// times are given in machine time through that offset. SYNC0 is placed `sync0_shift` after send(), in the phase in which send()
// was seen to be called during the bring-up; so run receive()/send() from start() on: they work in every phase, and send
// process data as soon as it is planned. Whoever pumps first must later send at multiples of the cycle. From then on a servo
// keeps that phase against the drift: add period_correction() to each period.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/alarm.hpp"
#include "core/process_image.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/bus_config.hpp"
#include "ecat/cycle/bus_health.hpp"
#include "ecat/cycle/bus_phase.hpp"
#include "ecat/mailbox/emergency_log.hpp"
#include "ecat/transport/transport.hpp"

namespace taktwerk::ecat {

struct Bus;

/// An SDO request in flight. Obtained from upload()/download(); polled from the service side.
using SdoTicket = std::uint32_t;
struct SdoResult {
    std::vector<std::byte> data;  ///< of an upload
};

class Master {
public:
    /// `transport` outlives the master. The configuration has passed check().
    Master(Transport& transport, BusConfig config);
    ~Master();
    Master(const Master&) = delete;
    Master& operator=(const Master&) = delete;

    // --- service side -------------------------------------------------------------------------------------------------
    using Phase = BusPhase;

    /// Starts the bring-up towards OP. It ends in `operational` or `failed` (see failure()).
    void start();
    /// Takes the bus down in order (OP -> SAFEOP -> INIT). Axes must be disabled before.
    void stop();
    /// Runs the scripts as far as answers are there.
    void step(Instant now);
    [[nodiscard]] Phase phase() const noexcept;
    /// One line for the operator: "slave 2 'y' PREOP -> SAFEOP: writing 1C12h".
    [[nodiscard]] std::string progress() const;
    /// Why the bring-up failed, with slave, state, code and text, and what to try.
    [[nodiscard]] const Error& failure() const;
    /// What happened since start() that an engineer wants to read: slaves that fell and came back. Newest last.
    [[nodiscard]] std::span<const std::string> notes() const noexcept;
    /// What the scripts share, for diagnosis (ecat/diagnosis/): scripts of one's own may run on its port. Valid until start().
    [[nodiscard]] Bus& bus() noexcept;
    /// What slaves sent unasked since start(), newest last; the newest hundred. Valid until the next step().
    [[nodiscard]] std::span<const SlaveEmergency> emergencies() const noexcept;

    [[nodiscard]] SdoTicket upload(std::size_t slave, std::uint16_t index, std::uint8_t sub);
    [[nodiscard]] SdoTicket download(std::size_t slave, std::uint16_t index, std::uint8_t sub, std::span<const std::byte> data);
    /// Nothing while it is in flight; afterwards the result, once.
    [[nodiscard]] std::optional<Result<SdoResult>> poll(SdoTicket ticket);

    // --- resolved once, after `configuring` -----------------------------------------------------------------------------
    [[nodiscard]] std::size_t slave_count() const noexcept;  ///< configured slaves, in configuration order
    [[nodiscard]] const SlaveConfig& slave(std::size_t index) const;
    /// Slaves that come and go together; constant.
    [[nodiscard]] std::span<const HotConnectGroup> groups() const noexcept;
    [[nodiscard]] Result<Signal> input(std::size_t slave, std::uint16_t object, std::uint8_t sub) const;
    [[nodiscard]] Result<Signal> output(std::size_t slave, std::uint16_t object, std::uint8_t sub) const;
    /// Whose bit of the outputs it is: for words. Service side.
    struct OutputPlace {
        std::size_t slave = 0;
        std::uint16_t object = 0;
        std::uint8_t sub = 0;
    };
    [[nodiscard]] std::optional<OutputPlace> output_at(std::size_t bit) const noexcept;
    [[nodiscard]] bool maps_output(std::size_t slave, std::uint16_t object, std::uint8_t sub) const noexcept;
    [[nodiscard]] bool maps_input(std::size_t slave, std::uint16_t object, std::uint8_t sub) const noexcept;
    /// Outputs that nobody asked for, of a slave whose PDOs nobody stated: whoever writes its outputs lets them be what they were.
    [[nodiscard]] std::span<const FoundOutput> found_outputs(std::size_t slave) const noexcept;
    /// What the slave answered to one of SlaveConfig::asked; nothing: it has no such object, or nobody asked.
    [[nodiscard]] std::optional<std::uint32_t> told(std::size_t slave, std::uint16_t object, std::uint8_t sub) const noexcept;

    // --- cyclic side, real-time safe --------------------------------------------------------------------------------------
    void pump(Instant now) noexcept;
    void receive(Instant now) noexcept;
    void send(Instant now) noexcept;
    [[nodiscard]] std::span<const std::byte> inputs() const noexcept;
    [[nodiscard]] std::span<std::byte> outputs() noexcept;
    [[nodiscard]] const SlaveHealth& health(std::size_t slave) const noexcept;
    /// Of groups()[group]. Goes to `absent` with the third cycle that comes back without its process data, or, of slaves that have none, as soon
    /// as the watch misses them.
    [[nodiscard]] GroupPresence group_presence(std::size_t group) const noexcept;
    [[nodiscard]] const BusStatistics& statistics() const noexcept;
    /// After send(): what has to be added to the period before the next cycle, so that the master's cycle stays locked to the
    /// reference clock (ecat/dc/cycle_servo.hpp). 0 without DC. At most a hundredth of the cycle.
    [[nodiscard]] Duration period_correction() const noexcept;
    /// The conditions of alarms() that hold now, at most out.size(). Returns how many.
    std::size_t active_faults(std::span<AlarmFact> out) const noexcept;
    /// More words about one of them, for whoever shows it: which cable, which reason. May be empty. Service side.
    [[nodiscard]] std::string detail(const AlarmFact& fact) const;
    /// When the drives will apply the outputs that the next send() carries: the next SYNC0, or the send itself without DC.
    [[nodiscard]] Instant outputs_effective(std::size_t slave, Instant send_time) const noexcept;
    /// Called by send() with each frame as it goes out, and by receive() with each as it came in: recorder, pcap. May be null.
    void set_tap(void (*tap)(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept, void* context) noexcept;

    static std::span<const AlarmInfo> alarms() noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace taktwerk::ecat
