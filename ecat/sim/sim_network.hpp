#pragma once
// A line of simulated slaves: the far end of the master's cable. Frames run through all slaves that have power and
// connection and come back; what is due in machine time happens in event order across the slaves. Deterministic: the same
// calls give the same bytes. process() and advance() are real-time safe as far as the device models are.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/time.hpp"
#include "ecat/sim/sim_slave.hpp"
#include "ecat/transport/loopback.hpp"

namespace taktwerk::ecat::sim {

/// Delays per slave and cable. Slaves turn a frame around inside when nothing is plugged in behind them.
struct LineTiming {
    Duration forward = std::chrono::nanoseconds{600};  ///< port 0 -> processing -> port 1
    Duration back = std::chrono::nanoseconds{400};     ///< port 1 -> port 0
    Duration cable = std::chrono::nanoseconds{50};     ///< one way, 10 m
};

class SimNetwork final : public FrameSink {
public:
    explicit SimNetwork(Instant start = Instant{}, LineTiming timing = {}) : timing_(timing), now_(start) {}

    /// Appends a slave at the end of the line and powers it on. The reference stays valid.
    SimSlave& add(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options = {});
    [[nodiscard]] std::size_t size() const noexcept { return slaves_.size(); }
    [[nodiscard]] SimSlave& slave(std::size_t position) noexcept { return *slaves_[position].slave; }
    [[nodiscard]] Instant now() const noexcept { return now_; }

    /// A slave without power ends the line before it; with power it starts from its reset values.
    void set_power(std::size_t position, bool on);
    /// Pulls (or plugs in) the cable before slave `position`; 0: the master's own cable, nothing comes back then.
    void set_cable(std::size_t position, bool plugged);
    /// The next frames vanish before any slave sees them.
    void lose_frames(std::uint32_t count) noexcept { lose_ = count; }
    /// Slaves that a frame reaches now.
    [[nodiscard]] std::size_t reachable() const noexcept;

    void advance(Instant now) noexcept override;
    std::optional<Duration> process(std::span<std::byte> frame, Instant now) noexcept override;
    /// When something is due next without a frame; Instant::max(): never.
    [[nodiscard]] Instant next_event() const noexcept { return next_event_; }

private:
    struct Place {
        std::unique_ptr<SimSlave> slave;
        bool cable = true;  // towards the master
    };
    void fire_until(Instant now) noexcept;
    void schedule() noexcept;
    void show_links() noexcept;

    // 12 bytes is the shortest datagram: more than this do not fit into a frame.
    static constexpr std::size_t max_datagrams = (max_frame_size - ethernet_header_size - ecat_header_size) / datagram_overhead;

    LineTiming timing_;
    std::vector<Place> slaves_;
    std::array<MutableDatagram, max_datagrams> datagrams_{};
    Instant now_;
    Instant next_event_ = never;
    std::uint32_t lose_ = 0;
};

}  // namespace taktwerk::ecat::sim
