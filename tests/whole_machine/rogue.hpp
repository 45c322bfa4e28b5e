#pragma once
// A program that behaves, until it is told not to. There is one machine at a time that has it.

#include "fb_library/all_blocks.hpp"
#include "programs/api/program.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::whole {

enum class Mischief : std::uint8_t { none, throws_in_scan, throws_in_stop, no_numbers, wrong_commands, takes_others_axis };

class Rogue final : public Program {
public:
    static inline Mischief mischief = Mischief::none;
    static inline std::string axis, output;  ///< that it declares; empty: none

    void declare(Declaration& d) override;
    void stop() override;
    void scan(TaskContext& ctx);

private:
    void command_nonsense(const TaskContext& ctx);

    AxisRef axis_;
    Output<double> output_;
    bool has_axis_ = false, has_output_ = false;
    std::int64_t scans_ = 0, refused_ = 0;
    fb::MC_MoveAbsolute move_;
    fb::MC_MoveVelocity run_;
    fb::MC_Stop halt_;
};

/// As the last program, started with the machine.
void add_rogue(runtime::MachineConfig& config);

}  // namespace taktwerk::whole
