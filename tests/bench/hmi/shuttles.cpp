// As many axes as the machine file has parameters for, all powered, all going to and fro: what the page's figures are taken on.

#include <array>
#include <cstddef>
#include <string>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Shuttles final : public Program {
    struct Shuttle {
        AxisRef axis;
        MC_Power power;
        MC_MoveAbsolute there, back;
    };
    static constexpr std::size_t axes = 64;
    std::array<Shuttle, axes> shuttles_;

public:
    void declare(Declaration& d) override {
        for (std::size_t i = 0; i < axes; ++i) shuttles_[i].axis = d.axis("a" + std::to_string(i + 1));
        d.task<&Shuttles::scan>("main");
    }

    void scan(TaskContext& ctx) {
        for (std::size_t i = 0; i < axes; ++i) {
            auto& s = shuttles_[i];
            s.power.Axis = s.there.Axis = s.back.Axis = s.axis;
            s.power.Enable = true;
            s.power(ctx);
            s.there.Position = 50 + static_cast<double>(i);  // no two of them turn in the same cycle for long
            s.back.Position = 0;
            s.there.Velocity = s.back.Velocity = 200;
            s.there.Execute = s.power.Status && !s.there.Done && !s.back.Busy;
            s.there(ctx);
            s.back.Execute = s.there.Done || s.back.Busy;
            s.back(ctx);
        }
    }
};

}  // namespace

TAKTWERK_PROGRAM(Shuttles)
