#pragma once
// MC_PathSelect, MC_MovePath: PLCopen Part 4 v2.0. Path_Handshake, ours: what a stored path asks for beside motion, and where it is. Real-time safe.

#include <cstdint>
#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// Prepares a stored path: its text is looked through from beginning to end, before anything moves.
struct MC_PathSelect : ExecuteBlock<MC_PathSelect> {
    GroupRef AxesGroup{};
    MC_PATH_DATA_REF PathData{};
    MC_PATH_REF PathDescription{};
    bool Execute = false;

    bool Done = false, Busy = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Prepares a stored path for MC_MovePath: looks through all of its text.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(), in_out<&Self::PathData>("", "the prepared path, once Done is TRUE"),
                         in_out<&Self::PathDescription>("", "which path, and how it is to be gone"), grouped<&Self::Execute>(),
                         out<&Self::Done>("", "it is prepared, and nothing was found wrong"),
                         grouped<&Self::Busy, &Self::Error, &Self::ErrorID>());
    }

private:
    friend ExecuteBlock<MC_PathSelect>;

    void start(const MotionContext& ctx) noexcept {
        PathData = {};
        if (view_of(ctx, AxesGroup) == nullptr) return core_.refuse(ErrorId::invalid_group);
        path_ = PathDescription.Path;
        const auto answer = ctx.groups->select(AxesGroup, path_, PathDescription.Options);
        if (answer.error != ErrorId::none) return core_.refuse(answer.error);
        ticket_ = answer.id;
        core_.start({});
    }
    void follow(const MotionContext& ctx) noexcept {
        const auto* state = ctx.groups->path(path_);
        if (state == nullptr || state->ticket != ticket_) return core_.refuse(ErrorId::path_not_selected);
        switch (state->kind) {
            case axes::PathState::Kind::refused: return core_.refuse(state->place.error);
            case axes::PathState::Kind::ready: PathData = {path_, ticket_}; return core_.finish();
            default: return;
        }
    }

    axes::PathRef path_{};
    std::uint32_t ticket_ = 0;
};

struct MC_MovePath : GroupCommandBlock<MC_MovePath> {
    GroupRef AxesGroup{};
    MC_PATH_DATA_REF PathData{};
    bool Execute = false;
    MC_CoordSystem CoordSystem = mcMCS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Moves the tool's point along a stored path, from where it stands to the path's end.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup>(), in_out<&Self::PathData>("", "from MC_PathSelect"),
            grouped<&Self::Execute, &Self::CoordSystem, &Self::BufferMode, &Self::TransitionMode, &Self::TransitionParameter>(),
            out<&Self::Done>("", "the path's end is reached"),
            grouped<&Self::Busy, &Self::Active, &Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        axes::GroupCommand command{
            .kind = axes::GroupCommandKind::path, .frame = CoordSystem, .buffer_mode = BufferMode, .transition = TransitionMode};
        command.transition_parameter = TransitionParameter.Parameter[0];
        command.path = PathData.path;
        command.ticket = PathData.ticket;
        return command;
    }
};

/// What a stored path asks for: M words, a pause of the operator. Nothing behind a request that waits is gone before Acknowledge rises.
struct Path_Handshake : GroupReadBlock<Path_Handshake> {
    GroupRef AxesGroup{};
    bool Enable = false;
    bool Acknowledge = false;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    std::uint32_t Line = 0, Block = 0;
    bool Waits = false;
    MC_PATH_REQUEST Request = axes::mcPathNothing;
    std::uint32_t RequestID = 0, Number = 0;
    double Value = 0, Second = 0;
    std::uint32_t FaultLine = 0, FaultColumn = 0;
    ErrorId FaultID{};

    static constexpr std::string_view summary = "Shows where a stored path is and what it asks for, and answers it.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable>(),
                         in<&Self::Acknowledge>("", "a rising edge while Waits: it is done, the path goes on"), reading<Self>(),
                         out<&Self::Line>("", "of the text, that is carried out; 0: none, or none any more"),
                         out<&Self::Block>("", "its N word; 0: none"), out<&Self::Waits>("", "the path stands until Acknowledge rises"),
                         out<&Self::Request>("", "what is asked for, last"), out<&Self::RequestID>("", "counts requests"),
                         out<&Self::Number>("", "of a tool, of M100 to M199"), out<&Self::Value>("1", "spindle: 1/min; M100 to M199: P"),
                         out<&Self::Second>("1", "M100 to M199: Q"),
                         out<&Self::FaultLine>("", "of the text, where the path ended too early, or what refused it; 0: nothing did"),
                         out<&Self::FaultColumn>("", "bytes from 1; 0: the line as a whole"),
                         out<&Self::FaultID>("", "why; 0: another command, a stop, the group's error"));
    }

    /// More than its group: it answers.
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const axes::GroupView* view = view_of(ctx, AxesGroup);
        if (view == nullptr) return Reading::unless(ErrorId::invalid_group);
        const auto& path = view->path;
        const bool edge = Acknowledge && !acknowledged_;
        acknowledged_ = Acknowledge;
        if (edge && path.waits) (void)ctx.groups->acknowledge(AxesGroup, path.request_id, ctx.owner);
        Line = path.line;
        Block = path.number == axes::PathView::no_block_number ? 0 : path.number;
        Waits = path.waits;
        Request = path.request.kind;
        RequestID = path.request_id;
        Number = path.request.number;
        Value = path.request.value;
        Second = path.request.second;
        FaultLine = path.place.line;
        FaultColumn = path.place.column;
        FaultID = path.place.error;
        return Reading::valid();
    }
    void clear() noexcept {
        Line = Block = RequestID = Number = FaultLine = FaultColumn = 0;
        Waits = acknowledged_ = false;
        Request = axes::mcPathNothing;
        Value = Second = 0;
        FaultID = ErrorId::none;
    }

private:
    bool acknowledged_ = false;
};

}  // namespace taktwerk::fb
