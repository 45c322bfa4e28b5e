#include "runtime/run_memory/block_queue.hpp"

#include <algorithm>

namespace taktwerk::runtime {

void BlockQueue::push(const PackedBlock& block) {
    const auto length = block.bytes.size();
    const bool begins = pieces_.empty() || pieces_.back().capacity() - pieces_.back().size() < length;
    if (begins) pieces_.emplace_back().reserve(std::max(piece, length));
    auto& to = pieces_.back();
    to.insert(to.end(), block.bytes.begin(), block.bytes.end());
    blocks_.push_back({length, block.records, begins});
    bytes_ += length;
}

PackedBlock BlockQueue::pop() {
    const auto first = blocks_.front();
    blocks_.pop_front();
    const auto from = pieces_.front().begin() + static_cast<std::ptrdiff_t>(read_);
    PackedBlock block{{from, from + static_cast<std::ptrdiff_t>(first.length)}, first.records};
    read_ += first.length;
    bytes_ -= first.length;
    if (blocks_.empty() || blocks_.front().begins_piece) {
        pieces_.pop_front();
        read_ = 0;
    }
    return block;
}

void BlockQueue::clear() noexcept {
    blocks_.clear();
    pieces_.clear();
    read_ = 0;
    bytes_ = 0;
}

}  // namespace taktwerk::runtime
