#include "axes/path_time/path_player.hpp"

namespace taktwerk::axes {

/// At the border in front of piece_: goes over to what is offered if that begins here; refuses it if that would have been earlier.
void PathPlayer::take_offer() noexcept {
    const TimeStretch* next = exchange_.look();
    if (next == nullptr) return;
    const std::uint32_t running = stretch_ != nullptr ? stretch_->id : 0;
    if (next->follows == running && stretch_ != nullptr && next->at_piece > piece_) return exchange_.leave();  // not yet
    if (next->follows == running && (stretch_ == nullptr || next->at_piece == piece_) && (standing() || border_)) {
        stretch_ = next;
        piece_ = 0;
    } else {
        ++late_;
    }
    exchange_.tell({stretch_ != nullptr ? stretch_->id : 0, piece_});
    exchange_.answer();
}

const PathMotion& PathPlayer::step(double period) noexcept {
    border_ = false;
    take_offer();
    if (!standing()) time_ += period;
    while (!standing() && time_ >= stretch_->pieces[static_cast<std::size_t>(piece_)].duration) {
        time_ -= stretch_->pieces[static_cast<std::size_t>(piece_)].duration;
        ++piece_;
        border_ = true;
        take_offer();
        border_ = false;
    }
    if (stretch_ == nullptr) return now_;
    if (standing()) {
        time_ = 0;
        const TimePiece& last = stretch_->pieces[static_cast<std::size_t>(stretch_->count - 1)];
        now_ = {last.begin + last.length, 0, 0, 0};
        part_ = last.part;
    } else {
        now_ = stretch_->pieces[static_cast<std::size_t>(piece_)].at(time_);
        part_ = stretch_->pieces[static_cast<std::size_t>(piece_)].part;
    }
    exchange_.tell({stretch_->id, piece_});
    return now_;
}

double PathPlayer::time_left() const noexcept {
    if (standing()) return 0;
    const TimePiece& last = stretch_->pieces[static_cast<std::size_t>(stretch_->count - 1)];
    const TimePiece& piece = stretch_->pieces[static_cast<std::size_t>(piece_)];
    return last.begin_time + last.duration - piece.begin_time - time_;
}

double PathPlayer::stretch_end() const noexcept {
    if (stretch_ == nullptr) return now_.s;
    const TimePiece& last = stretch_->pieces[static_cast<std::size_t>(stretch_->count - 1)];
    return last.begin + last.length;
}

}  // namespace taktwerk::axes
