#pragma once
// The machine's named points: signals resolved once, raw words read and written once per cycle, and what they mean in units. What people force
// is put in place here: behind the terminal of an input, before that of an output.

#include <cstdint>
#include <span>
#include <vector>

#include "core/point_line.hpp"
#include "core/process_image.hpp"
#include "core/result.hpp"
#include "ecat/master.hpp"
#include "runtime/forced_point.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class IoImage {
public:
    IoImage(const std::vector<IoPoint>& points, Duration cycle);

    /// Once the bus has laid out its process image.
    [[nodiscard]] Result<void> resolve(const ecat::Master& bus);

    /// Process image -> input values (step 3). Points of a slave that was not exchanged keep their values. Real-time safe.
    void read(std::span<const std::byte> image, const ecat::Master& bus) noexcept;
    /// Output values -> process image (step 8). Real-time safe.
    /// An output keeps no more than its terminal has: what traces and programs read of it is what the wire carries. Those of a group that is not
    /// present carry their safe values; what was written counts from the cycle on in which it is.
    void write(std::span<std::byte> image) noexcept;
    /// Of points beside the bus, for who carries them: what an input's device said last, and whether that is young enough; the word that an
    /// output shall have there. Real-time safe.
    void take_beside(std::size_t input, std::int64_t word, bool fresh) noexcept;
    [[nodiscard]] std::int64_t beside(std::size_t output) const noexcept;

    /// --- forces: people put a value in place of what the terminal says (input) or of what is written (output). Real-time safe ---
    /// A forced input is what everybody reads, and good; what its terminal says goes on being supervised (trouble()). What is written to a forced
    /// output is kept, and goes out again when the force ends. `value` in the unit of the point; it can_force().
    [[nodiscard]] bool can_force(IoDirection direction, std::size_t index, double value) const noexcept;
    /// False: max_forces are in force.
    bool force(IoDirection direction, std::size_t index, double value, std::uint32_t client) noexcept;
    void release_force(IoDirection direction, std::size_t index) noexcept;
    void release_forces_of(std::uint32_t client) noexcept;
    void release_forces() noexcept;
    void release_output_forces() noexcept;
    [[nodiscard]] std::span<const ForcedPoint> forces() const noexcept { return {forces_.data(), forces_.size()}; }

    /// Every output to its configured safe value.
    void make_safe() noexcept;
    void make_safe(std::size_t output) noexcept { outputs_[output] = output_points_[output].config.safe_value; }

    [[nodiscard]] std::vector<std::int64_t>& inputs() noexcept { return inputs_; }
    /// As written by programs, people and drives; a force stands beside it.
    [[nodiscard]] std::vector<std::int64_t>& outputs() noexcept { return outputs_; }
    /// As it goes out: for who shows it.
    [[nodiscard]] std::int64_t output_word(std::size_t output) const noexcept {
        const auto& point = output_points_[output];
        return point.forced ? point.forced_word : outputs_[output];
    }
    /// Each input in its unit, and whether it can be believed.
    [[nodiscard]] const std::vector<PointValue>& input_values() const noexcept { return input_values_; }
    /// What its terminal says, also while it is forced.
    [[nodiscard]] const PointValue& measured(std::size_t input) const noexcept {
        return input_points_[input].forced ? input_points_[input].real : input_values_[input];
    }
    /// From the raw words of the outputs to their units.
    [[nodiscard]] const std::vector<PointLine>& output_lines() const noexcept { return output_lines_; }
    [[nodiscard]] double output_value(std::size_t output) const noexcept { return output_lines_[output].value_of(output_word(output)); }

    /// What is wrong with an input in this cycle.
    enum class Trouble : std::uint8_t { none, error, underrange, overrange, no_number, below_limit, above_limit };
    [[nodiscard]] Trouble trouble(std::size_t input) const noexcept { return troubles_[input]; }
    /// Bits of each output point.
    [[nodiscard]] const std::vector<std::uint8_t>& output_bits() const noexcept { return output_bits_; }

    /// Whether an output point can take the value: within the bits of the terminal and, where it has no unit, whole. Real-time safe.
    [[nodiscard]] bool fits(std::size_t output, double value) const noexcept;
    /// An output by its value; it fits(). Real-time safe.
    void set_output(std::size_t output, double value) noexcept { outputs_[output] = output_lines_[output].raw_of(value); }

    /// Index among the points of that direction, in configuration order; -1 when there is none.
    [[nodiscard]] int find(IoDirection direction, std::string_view name) const noexcept;
    [[nodiscard]] const IoPoint& point(IoDirection direction, std::size_t index) const noexcept;
    [[nodiscard]] std::vector<std::string> names(IoDirection direction) const;

private:
    struct Status {
        PointStatus::Kind kind;
        Signal signal;
    };
    struct Point {
        IoPoint config;
        Signal signal;
        std::size_t slave = 0;
        std::vector<Status> status;
        bool seen = false;  ///< the filter has begun
        int group = -1;     ///< of hot connect; -1: always there
        bool away = false;  ///< that group is not present
        bool forced = false;
        std::int64_t forced_word = 0;  ///< output
        std::int64_t real_word = 0;    ///< input: what its terminal says, while it is forced ...
        PointValue real{};             ///< ... and in its unit
        struct Beside {
            std::int64_t word = 0;
            bool fresh = false;
        } beside{};
    };
    [[nodiscard]] Result<void> resolve(const ecat::Master& bus, Point& point) const;
    /// What the bus says of the point's group. True: there is nothing behind it to be read.
    void read_presence(const ecat::Master& bus) noexcept;
    bool watch_group(std::size_t input, const ecat::Master& bus) noexcept;
    [[nodiscard]] Result<Signal> signal_of(const ecat::Master& bus, const Point& point, std::uint16_t index, std::uint8_t sub) const;
    /// What its terminal says, whatever is forced.
    [[nodiscard]] std::int64_t& word_of(std::size_t input) noexcept {
        return input_points_[input].forced ? input_points_[input].real_word : inputs_[input];
    }
    [[nodiscard]] PointValue& value_of(std::size_t input) noexcept {
        return input_points_[input].forced ? input_points_[input].real : input_values_[input];
    }
    void end_force(const ForcedPoint& force) noexcept;
    template <class Which>
    void release_those(Which which) noexcept;
    /// `fresh`: its device was heard in this cycle; `young`: not too long ago.
    void judge(std::size_t input, std::span<const std::byte> image, bool fresh, bool young) noexcept;

    double cycle_s_;
    std::vector<Point> input_points_, output_points_;
    std::vector<std::int64_t> inputs_, outputs_;
    std::vector<PointValue> input_values_;
    std::vector<Trouble> troubles_;
    std::vector<PointLine> output_lines_;
    std::vector<std::uint8_t> output_bits_;
    std::vector<ForcedPoint> forces_;  ///< has its memory from the start
};

}  // namespace taktwerk::runtime
