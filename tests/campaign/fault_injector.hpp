#pragma once
// Does one fault to a test machine and takes it back when its time is over.

#include <random>
#include <string>

#include "tests/campaign/fault_kind.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::campaign {

class FaultInjector {
public:
    FaultInjector(runtime::testing::TestMachine& machine, FaultKind kind, std::mt19937& random)
        : m_(machine), kind_(kind), random_(random) {}

    /// The fault begins. A stall happens whole in here.
    void strike();
    /// Once a cycle while it lasts.
    void step();
    [[nodiscard]] bool over() const;
    /// The cause goes, whatever is left of it (but not one that is for_good).
    void heal();
    /// Also one that is for good: for the next bring-up.
    void repair();
    [[nodiscard]] std::size_t slave() const noexcept { return slave_; }
    [[nodiscard]] const std::string& deed() const noexcept { return deed_; }

private:
    [[nodiscard]] std::uint32_t between(std::uint32_t low, std::uint32_t high) { return std::uniform_int_distribution{low, high}(random_); }
    [[nodiscard]] Duration milliseconds(std::uint32_t low, std::uint32_t high) { return std::chrono::milliseconds{between(low, high)}; }
    void strike_frames();
    void strike_slave();
    void strike_as_second_master();
    void stall(Duration length);
    void write(ecat::Address address, std::uint16_t value);

    runtime::testing::TestMachine& m_;
    FaultKind kind_;
    std::mt19937& random_;
    std::size_t slave_ = 0;
    Instant began_{};
    Duration length_{};
    Duration second_off_{}, second_on_{};
    std::string deed_;
};

}  // namespace taktwerk::campaign
