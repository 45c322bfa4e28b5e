#pragma once
// What the links of an arm weigh: MC_GroupWriteRigidBodyDynamic, MC_GroupReadRigidBodyDynamic. PLCopen Part 4 v2.0. Real-time safe. No set-point depends
// on it.

#include <string_view>

#include "fb_library/groups/group_block.hpp"
#include "fb_library/groups/group_equipment_types.hpp"

namespace taktwerk::fb {

/// All of them at once; those behind RigidBodyCount are gone.
struct MC_GroupWriteRigidBodyDynamic : GroupSettingBlock<MC_GroupWriteRigidBodyDynamic> {
    GroupRef AxesGroup{};
    bool Execute = false;
    std::int16_t RigidBodyCount = 0;
    RigidBodies RigidBodyDynamic{};

    bool CommandAborted = false, Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Keeps the rigid bodies that the group's links are, for who asks for them.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::RigidBodyCount>("", "0 to 8"),
                         in<&Self::RigidBodyDynamic>("", "kg, u, kg m2; from the base on"),
                         out<&Self::CommandAborted>("", "never: they are written at once"), out<&Self::Done>("", "written"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupSetting setting() const noexcept {
        axes::WriteBodies all{.count = detail::number_of(RigidBodyCount), .bodies = {}};
        for (std::size_t i = 0; i < all.bodies.size() && i < all.count; ++i) all.bodies[i] = detail::written_of(RigidBodyDynamic[i]);
        return all;
    }
};

struct MC_GroupReadRigidBodyDynamic : EnableBlock<MC_GroupReadRigidBodyDynamic> {
    GroupRef AxesGroup{};
    bool Enable = false;

    bool CommandAborted = false, Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::int16_t RigidBodyCount = 0;
    RigidBodies RigidBodyDynamic{};

    static constexpr std::string_view summary = "Gives the rigid bodies that were written.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(), out<&Self::CommandAborted>("", "never: it only reads"),
                         reading<Self>(), out<&Self::RigidBodyCount>("", "0 to 8"), out<&Self::RigidBodyDynamic>("", "kg, u, kg m2"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto* known = detail::equipment_of(ctx, AxesGroup);
        if (known == nullptr) return Reading::unless(ErrorId::invalid_group);
        RigidBodyCount = known->body_count;
        for (std::size_t i = 0; i < RigidBodyDynamic.size(); ++i) RigidBodyDynamic[i] = detail::pin_of(known->bodies[i]);
        return Reading::valid();
    }
    void clear() noexcept {
        RigidBodyCount = 0;
        RigidBodyDynamic = {};
    }
};

}  // namespace taktwerk::fb
