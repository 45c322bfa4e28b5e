#pragma once
// The serial lines of a simulated machine: a computed line each, XP200 drives at its end, their contacts wired to the mechanics and to the
// machine's outputs. Lines and drives live on the service side: the machine's service steps each line's client, which looks at its line each
// time, and that is how time passes for the drives, in virtual time and on the service thread alike. What the cycle's side tells them passes
// through atomics and a ring.

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "axes/sim/xp200/station.hpp"
#include "core/spsc_ring.hpp"
#include "modbus/line/virtual_line.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class SerialWorld {
public:
    SerialWorld() = default;

    /// All lines at once, before the machine starts. `plants`: one per axis of `config`, in its order.
    void build(const MachineConfig& config, const std::vector<axes::sim::PlantConfig>& plants, Instant start);

    /// As many as the configuration has, in its order; for Machine::build.
    [[nodiscard]] std::vector<modbus::SerialLine*> lines() noexcept;

    // --- the cycle's side ---------------------------------------------------------------------------------------------------
    /// True: the event was one of a drive or line here.
    bool happen(const SimulationEvent& event) noexcept;
    /// The level of a drive's watchdog output, at the terminal. Each cycle.
    template <class Output>
    void wire(const Output& output) {
        for (auto& drive : drives_)
            if (!drive->watchdog.empty()) drive->watchdog_on.store(output(drive->watchdog), std::memory_order_relaxed);
    }

    // --- the other end of a line that is really there ------------------------------------------------------------------------
    /// The drives on a line, for whoever serves them himself (modbus/line/pseudo_terminal.hpp); then nobody may use lines().
    [[nodiscard]] std::vector<modbus::Station*> stations(std::string_view line) noexcept;
    /// An event has cut it.
    [[nodiscard]] bool is_cut(std::string_view line) const noexcept;

    // --- hands on, in virtual time only ----------------------------------------------------------------------------------------
    /// nullptr when the axis is on none.
    [[nodiscard]] axes::sim::xp200::Drive* drive(std::string_view axis) noexcept;
    [[nodiscard]] modbus::VirtualLine* line(std::string_view name) noexcept;

private:
    struct Happening {
        SimulationEvent::Kind kind = SimulationEvent::Kind::main_power;
        std::int64_t value = 0;
    };
    /// The drive with its wires.
    struct WiredDrive final : modbus::Station {
        WiredDrive(const axes::DriveProfile& profile, const axes::sim::PlantConfig& plant) : model(profile, plant) {}
        void advance(Instant now) override;
        bool hear(std::span<const std::byte> frame, Instant now, modbus::Frame& answer) override { return model.hear(frame, now, answer); }
        [[nodiscard]] Duration turnaround() const noexcept override { return model.turnaround(); }
        [[nodiscard]] modbus::LineSettings line() const noexcept override { return model.line(); }

        axes::sim::xp200::Drive model;
        std::string axis, watchdog;
        int stop_input = -1, home_input = -1;
        std::atomic<bool> watchdog_on{false};
        SpscRing<Happening> happenings{16};
    };
    struct Line {
        Line(std::string its_name, const modbus::LineSettings& settings) : name(std::move(its_name)), line(settings) {}
        std::string name;
        modbus::VirtualLine line;
        std::atomic<bool> cut{false};
        std::vector<WiredDrive*> drives;
    };
    /// What the machine gets: the line, cut when an event says so.
    struct Cable final : modbus::SerialLine {
        explicit Cable(Line& end) : line(end) {}
        [[nodiscard]] const modbus::LineSettings& settings() const noexcept override { return line.line.settings(); }
        bool send(std::span<const std::byte> frame, Instant now) override {
            follow();
            return line.line.send(frame, now);
        }
        std::size_t receive(std::span<std::byte> into, Instant now) override {
            follow();
            return line.line.receive(into, now);
        }
        void discard(Instant now) override {
            follow();
            line.line.discard(now);
        }
        [[nodiscard]] bool present() const noexcept override { return true; }
        void follow() noexcept {
            if (const bool wanted = line.cut.load(std::memory_order_relaxed); wanted != was_cut) line.line.cut(was_cut = wanted);
        }
        Line& line;
        bool was_cut = false;
    };

    std::vector<std::unique_ptr<WiredDrive>> drives_;
    std::vector<std::unique_ptr<Line>> lines_;
    std::vector<std::unique_ptr<Cable>> cables_;
};

}  // namespace taktwerk::runtime
