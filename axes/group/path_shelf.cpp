#include "axes/group/path_shelf.hpp"

namespace taktwerk::axes {

void PathShelf::add(std::unique_ptr<PathMaker> maker) {
    makers_.push_back(std::move(maker));
    programs_.emplace_back();
    states_.emplace_back();
}

std::uint32_t PathShelf::select(PathRef path, const PathOptions& options, const std::array<double, 3>& start, double millimetre) noexcept {
    if (path.index >= states_.size()) return 0;
    const std::uint32_t ticket = tickets_ + 1 != 0 ? tickets_ + 1 : 1;
    if (!wanted_.try_push({path, ticket, options, start, millimetre})) return 0;
    tickets_ = ticket;
    states_[path.index] = {.kind = PathState::Kind::preparing, .ticket = ticket};
    return ticket;
}

void PathShelf::take_answers() noexcept {
    for (Answer answer; answers_.try_pop(answer);)
        if (answer.state.ticket == states_[answer.path.index].ticket) states_[answer.path.index] = answer.state;
}

void PathShelf::service() {
    if (unsaid_) unsaid_ = !answers_.try_push(answer_);
    if (unsaid_) return;
    if (!working_) {
        if (!wanted_.try_pop(at_)) return;
        programs_[at_.path.index].reset();
        makers_[at_.path.index]->begin(at_.options, at_.start, at_.millimetre);
        working_ = true;
    }
    auto made = makers_[at_.path.index]->step();
    if (!made) return;
    working_ = false;
    answer_.path = at_.path;
    answer_.state = {.kind = made->program ? PathState::Kind::ready : PathState::Kind::refused,
                     .ticket = at_.ticket,
                     .lines = made->lines,
                     .place = made->place};
    programs_[at_.path.index] = std::move(made->program);
    unsaid_ = !answers_.try_push(answer_);
}

}  // namespace taktwerk::axes
