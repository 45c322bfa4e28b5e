#pragma once
// MC_CombineAxes: PLCopen Part 1 v2.0, 4.10. Real-time safe.

#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

/// Slave = ratio1 * master1 +- ratio2 * master2, as motion from where each is at the start. Only another command ends it.
struct MC_CombineAxes : CommandBlock<MC_CombineAxes> {
    AxisRef Master1{}, Master2{}, Slave{};
    bool Execute = false;
    bool ContinuousUpdate = false;
    MC_CombineMode CombineMode = mcAddAxes;
    std::int32_t GearRatioNumeratorM1 = 1, GearRatioDenominatorM1 = 1, GearRatioNumeratorM2 = 1, GearRatioDenominatorM2 = 1;
    MC_Source MasterValueSourceM1 = mcSetValue, MasterValueSourceM2 = mcSetValue;
    MC_BufferMode BufferMode = mcAborting;

    bool InSync = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr auto kind = axes::CommandKind::combine;
    static constexpr bool MC_CombineAxes::*in_target_pin = &MC_CombineAxes::InSync;
    static constexpr std::string_view summary = "Moves the slave by the sum or difference of two masters.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(in_out<&Self::Master1>("", "first leading axis; taken at the edge"),
                         in_out<&Self::Master2>("", "second leading axis; taken at the edge"),
                         shared<&Self::Slave, &Self::Execute, &Self::ContinuousUpdate>(),
                         in<&Self::CombineMode>("", "sum, or first minus second"),
                         in<&Self::GearRatioNumeratorM1>("", "factor of the first master, signed; default 1"),
                         in<&Self::GearRatioDenominatorM1>("", "divisor of the first master, not 0; default 1"),
                         in<&Self::GearRatioNumeratorM2>("", "factor of the second master, signed; default 1"),
                         in<&Self::GearRatioDenominatorM2>("", "divisor of the second master, not 0; default 1"),
                         in<&Self::MasterValueSourceM1>("", "set or actual value of the first master"),
                         in<&Self::MasterValueSourceM2>("", "set or actual value of the second master"), shared<&Self::BufferMode>(),
                         out<&Self::InSync>("", "the slave moves as the masters say"), outcome<Self>());
    }

    [[nodiscard]] axes::CombineDetails details() const noexcept {
        return {Master1,
                Master2,
                {GearRatioNumeratorM1, GearRatioDenominatorM1},
                {GearRatioNumeratorM2, GearRatioDenominatorM2},
                MasterValueSourceM1,
                MasterValueSourceM2,
                CombineMode};
    }
};

}  // namespace taktwerk::fb
