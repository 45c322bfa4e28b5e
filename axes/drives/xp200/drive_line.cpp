#include "axes/drives/xp200/drive_line.hpp"

namespace taktwerk::axes::xp200 {

bool DriveLine::ask(Xp200Drive& drive, Instant now) {
    if (now < client_.saving_until(drive.config().station)) return false;
    const auto request = drive.next_request(now);
    if (!request || client_.ask(*request, now) != modbus::Refusal::none) return false;
    asking_ = &drive;
    return true;
}

void DriveLine::step(Instant now) {
    if (const auto answer = client_.step(now); answer && asking_ != nullptr) {
        asking_->take(*answer, now);
        asking_ = nullptr;
    }
    if (!client_.idle(now)) return;
    for (auto* drive : drives_)
        if (drive->urgent() && ask(*drive, now)) return;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
        turn_ = (turn_ + 1) % drives_.size();
        if (ask(*drives_[turn_], now)) return;
    }
}

}  // namespace taktwerk::axes::xp200
