// Blocks come out as they went in, in their order, whatever their lengths; and the memory they stand in is what they need and little more.
#include "runtime/run_memory/block_queue.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace taktwerk::runtime {
namespace {

PackedBlock drawn(std::mt19937& random) {
    const std::size_t longest = random() % 20 == 0 ? 2 * BlockQueue::piece : 30'000;
    PackedBlock block;
    block.bytes.resize(random() % longest);
    for (auto& byte : block.bytes) byte = static_cast<std::byte>(random());
    block.records = random() % 5000;
    return block;
}

TEST(BlockQueue, GivesWhatItWasGivenInItsOrder) {
    std::mt19937 random{7};
    BlockQueue queue;
    std::deque<PackedBlock> model;
    std::size_t taken = 0;
    for (int step = 0; step < 20'000; ++step) {
        const bool grows = (step / 500) % 2 == 0;
        if (random() % 10 < (grows ? 6u : 4u)) {
            model.push_back(drawn(random));
            queue.push(model.back());
        } else if (!model.empty()) {
            const auto block = queue.pop();
            ASSERT_EQ(block.bytes, model.front().bytes) << "step " << step;
            ASSERT_EQ(block.records, model.front().records);
            model.pop_front();
            ++taken;
        }
        if (step % 5003 == 5002) {
            queue.clear();
            model.clear();
        }
        std::uint64_t bytes = 0;
        for (const auto& block : model) bytes += block.bytes.size();
        ASSERT_EQ(queue.bytes(), bytes);
        ASSERT_EQ(queue.empty(), model.empty());
    }
    EXPECT_GT(taken, 5000u);
}

}  // namespace
}  // namespace taktwerk::runtime
