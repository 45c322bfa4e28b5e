// Ethernet frames in pieces and back: each frame arrives as it was; of a frame whose pieces are lost, doubled or exchanged nothing arrives, and
// the next one does.
#include <gtest/gtest.h>

#include <random>

#include "ecat/eoe/frame_assembly.hpp"
#include "ecat/eoe/frame_cutter.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::ecat {
namespace {

using Frame = std::vector<std::byte>;

Frame drawn(std::mt19937& random, std::size_t size) {
    Frame frame(size);
    for (auto& byte : frame) byte = static_cast<std::byte>(random() & 0xFFu);
    return frame;
}

/// Each with the bytes it points into.
std::vector<EoeFragment> pieces(const Frame& frame, std::size_t mailbox, std::uint8_t number) {
    FrameCutter cutter{frame, mailbox, number};
    EXPECT_TRUE(cutter.possible()) << frame.size() << " through " << mailbox;
    std::vector<EoeFragment> out;
    while (const auto piece = cutter.next()) out.push_back(*piece);
    return out;
}

TEST(FramePieces, EveryLengthThroughEveryMailboxComesBack) {
    std::mt19937 random{1};
    FrameAssembly assembly;
    std::uint8_t number = 0;
    for (const std::size_t mailbox : {48u, 64u, 128u, 200u, 512u, 1486u, 1600u})
        for (std::size_t size = shortest_ethernet_frame; size <= longest_ethernet_frame; size += size < 200 ? 1 : 37) {
            const Frame frame = drawn(random, size);
            std::optional<std::span<const std::byte>> whole;
            std::size_t count = 0;
            for (const auto& piece : pieces(frame, mailbox, number)) {
                EXPECT_FALSE(whole) << "only the last completes it";
                whole = assembly.take(piece);
                EXPECT_TRUE(piece.last || piece.data.size() % eoe_block == 0);
                ++count;
            }
            ASSERT_TRUE(whole) << size << " through " << mailbox;
            ASSERT_EQ(Frame(whole->begin(), whole->end()), frame);
            EXPECT_EQ(count, (size + eoe_room(mailbox) - 1) / eoe_room(mailbox));
            number = static_cast<std::uint8_t>((number + 1) & 0xF);
        }
    EXPECT_EQ(assembly.dropped(), 0u);
}

TEST(FramePieces, WhatDoesNotFitThroughIsSaidBefore) {
    const Frame frame(1518);
    EXPECT_TRUE((FrameCutter{frame, 42, 0}.possible())) << "48 pieces of 32 bytes";
    EXPECT_FALSE((FrameCutter{frame, 41, 0}.possible())) << "no block fits";
    EXPECT_FALSE((FrameCutter{Frame(1519), 1600, 0}.possible()));
    EXPECT_FALSE((FrameCutter{Frame(13), 1600, 0}.possible()));
}

TEST(FramePieces, AFrameWithADisturbedPieceIsDroppedAloneAndNeverDelivered) {
    std::size_t disturbed = 0;
    for (std::size_t n = 0; n < property_cases(500); ++n) {
        std::mt19937 random{static_cast<std::mt19937::result_type>(n + 1)};
        FrameAssembly assembly;
        const Frame frame = drawn(random, 200 + random() % 1300), next = drawn(random, 60 + random() % 1400);
        auto row = pieces(frame, 128, 3);
        const auto at = static_cast<std::ptrdiff_t>(random() % row.size());
        switch (random() % 3) {
            case 0: row.erase(row.begin() + at); break;
            case 1: row.insert(row.begin() + at, row[static_cast<std::size_t>(at)]); break;
            default: std::swap(row[static_cast<std::size_t>(at)], row[(static_cast<std::size_t>(at) + 1) % row.size()]);
        }
        ++disturbed;
        for (const auto& piece : row)
            if (const auto whole = assembly.take(piece)) {
                // The first piece twice begins the frame twice: that one is whole.
                EXPECT_EQ(Frame(whole->begin(), whole->end()), frame) << "seed " << n + 1;
            }
        std::optional<std::span<const std::byte>> whole;
        for (const auto& piece : pieces(next, 128, 4)) whole = assembly.take(piece);
        ASSERT_TRUE(whole) << "seed " << n + 1;
        EXPECT_EQ(Frame(whole->begin(), whole->end()), next);
    }
    EXPECT_GT(disturbed, 0u);
}

}  // namespace
}  // namespace taktwerk::ecat
