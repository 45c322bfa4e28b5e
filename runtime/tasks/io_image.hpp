#pragma once
// The machine's named points: signals resolved once, values read and written once per cycle as plain integers.

#include <cstdint>
#include <span>
#include <vector>

#include "core/process_image.hpp"
#include "core/result.hpp"
#include "ecat/master.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class IoImage {
public:
    explicit IoImage(const std::vector<IoPoint>& points);

    /// Once the bus has laid out its process image.
    [[nodiscard]] Result<void> resolve(const ecat::Master& bus);

    /// Process image -> input values (step 3). Points of a slave that was not exchanged keep their values. Real-time safe.
    void read(std::span<const std::byte> image) noexcept;
    /// Output values -> process image (step 8). Real-time safe.
    /// An output keeps no more than its terminal has: what traces and programs read of it is what the wire carries.
    void write(std::span<std::byte> image) noexcept;
    /// Every output to its configured safe value.
    void make_safe() noexcept;
    void make_safe(std::size_t output) noexcept { outputs_[output] = output_points_[output].config.safe_value; }

    [[nodiscard]] std::vector<std::int64_t>& inputs() noexcept { return inputs_; }
    [[nodiscard]] std::vector<std::int64_t>& outputs() noexcept { return outputs_; }
    /// Bits of each output point.
    [[nodiscard]] const std::vector<std::uint8_t>& output_bits() const noexcept { return output_bits_; }

    /// Whether an output point can take the value: whole, and within the bits of the terminal. Real-time safe.
    [[nodiscard]] bool fits(std::size_t output, double value) const noexcept;

    /// Index among the points of that direction, in configuration order; -1 when there is none.
    [[nodiscard]] int find(IoDirection direction, std::string_view name) const noexcept;
    [[nodiscard]] const IoPoint& point(IoDirection direction, std::size_t index) const noexcept;
    [[nodiscard]] std::vector<std::string> names(IoDirection direction) const;

private:
    struct Point {
        IoPoint config;
        Signal signal;
    };
    std::vector<Point> input_points_, output_points_;
    std::vector<std::int64_t> inputs_, outputs_;
    std::vector<std::uint8_t> output_bits_;
};

}  // namespace taktwerk::runtime
