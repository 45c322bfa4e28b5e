#pragma once
// A tree of simulated slaves: the far end of the master's cable. Frames run through all slaves that have power and connection
// and come back; what is due in machine time happens in event order across the slaves. Deterministic: the same calls give the
// same bytes. process() and advance() are real-time safe as far as the device models are. How they hang together, and which way a
// frame takes: wiring.hpp.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "ecat/sim/sim_slave.hpp"
#include "ecat/sim/wiring.hpp"
#include "ecat/transport/loopback.hpp"

namespace taktwerk::ecat::sim {

/// What slaves and cables have that are not told otherwise.
struct LineTiming {
    SlaveDelays slave{};
    Duration cable = cable_delay(10);  ///< one way
};

class SimNetwork final : public FrameSink {
public:
    explicit SimNetwork(Instant start = Instant{}, LineTiming timing = {}) : timing_(timing), now_(start) {}
    SimNetwork(const SimNetwork&) = delete;
    SimNetwork& operator=(const SimNetwork&) = delete;

    /// Appends a slave to the line, behind port 1 of the one added last (behind its port 0 where that one was entered through
    /// port 1), and powers it on. The reference stays valid; positions change when a slave is added before others.
    SimSlave& add(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options = {});
    /// Hangs a slave behind `port` of `parent`. The port must be free (port_free()). `entry_port`: the new slave's socket that
    /// the cable goes into; 1..3: plugged into an OUT socket, which changes the order of processing (wiring.hpp).
    SimSlave& add_behind(SimSlave& parent, unsigned port, std::shared_ptr<const DeviceDescription> description,
                         std::unique_ptr<DeviceModel> model, SlaveOptions options = {}, unsigned entry_port = 0);
    [[nodiscard]] bool port_free(const SimSlave& parent, unsigned port) const noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return wiring_.places().size(); }
    /// Positions count in the order in which a frame is processed when every cable is plugged in and every slave is on.
    [[nodiscard]] SimSlave& slave(std::size_t position) noexcept { return *wiring_.places()[position]->slave; }
    [[nodiscard]] std::size_t position(const SimSlave& slave) const noexcept;
    [[nodiscard]] Instant now() const noexcept { return now_; }

    /// A slave without power ends its branch; with power it starts from its reset values.
    void set_power(SimSlave& slave, bool on);
    void set_power(std::size_t position, bool on) { set_power(slave(position), on); }
    /// Pulls (or plugs in) the cable that leads to the slave from the master's side. Position 0: the master's own cable, nothing
    /// comes back then.
    void set_cable(const SimSlave& slave, bool plugged);
    void set_cable(std::size_t position, bool plugged) { set_cable(slave(position), plugged); }
    /// A ring: the master's second interface is plugged into `port` of `last`. Returns what its transport sends to; frames come out where
    /// came_out_elsewhere() says. Call once, when all slaves are there.
    [[nodiscard]] FrameSink& close_ring(const SimSlave& last, unsigned port = 1);
    /// The cable of the second interface.
    void set_ring_cable(bool plugged);
    /// One way through the cable that leads to the slave.
    void set_cable_delay(const SimSlave& slave, Duration one_way);
    void set_delays(const SimSlave& slave, const SlaveDelays& delays);
    /// The next frames vanish before any slave sees them.
    void lose_frames(std::uint32_t count) noexcept { lose_ = count; }
    /// The next frames are damaged on the cable that leads to the slave: what is before it acts on them, it and all behind count
    /// errors (0300h, 0308h), and the master's network card throws them away.
    void disturb(const SimSlave& slave, std::uint32_t frames) noexcept;
    /// Slaves that a frame reaches now.
    [[nodiscard]] std::size_t reachable() const noexcept { return wiring_.route(CableEnd::first).visits.size(); }

    void advance(Instant now) noexcept override;
    std::optional<Duration> process(std::span<std::byte> frame, Instant now) noexcept override {
        return process(frame, now, CableEnd::first);
    }
    [[nodiscard]] bool came_out_elsewhere() const noexcept override { return last_left_elsewhere_; }
    /// When something is due next without a frame; Instant::max(): never.
    [[nodiscard]] Instant next_event() const noexcept { return next_event_; }

private:
    struct SecondEnd final : FrameSink {
        explicit SecondEnd(SimNetwork& its_network) : network(its_network) {}
        void advance(Instant now) noexcept override { network.advance(now); }
        std::optional<Duration> process(std::span<std::byte> frame, Instant now) noexcept override {
            return network.process(frame, now, CableEnd::second);
        }
        [[nodiscard]] bool came_out_elsewhere() const noexcept override { return network.last_left_elsewhere_; }
        SimNetwork& network;
    };
    [[nodiscard]] std::optional<Duration> process(std::span<std::byte> frame, Instant now, CableEnd from) noexcept;
    SimSlave& install(Place* parent, unsigned port, std::unique_ptr<SimSlave> slave, unsigned entry_port);
    void fire_until(Instant now) noexcept;
    void schedule() noexcept;
    void count_damage(const Place& where, CableEnd from) noexcept;
    [[nodiscard]] std::optional<std::size_t> take_apart(std::span<std::byte> frame) noexcept;

    // 12 bytes is the shortest datagram: more than this do not fit into a frame.
    static constexpr std::size_t max_datagrams = (max_frame_size - ethernet_header_size - ecat_header_size) / datagram_overhead;

    LineTiming timing_;
    Wiring wiring_;
    Place* last_ = nullptr;  // added
    std::array<MutableDatagram, max_datagrams> datagrams_{};
    Instant now_;
    Instant next_event_ = never;
    SecondEnd second_end_{*this};
    bool last_left_elsewhere_ = false;  // the frame processed last left at the end where it did not start
    std::uint32_t lose_ = 0;
    std::uint32_t damage_ = 0;        // so many frames more
    const Place* damaged_ = nullptr;  // on the cable to this one
};

}  // namespace taktwerk::ecat::sim
