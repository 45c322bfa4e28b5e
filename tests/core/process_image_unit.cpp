#include "core/process_image.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

namespace taktwerk {
namespace {

using Image = std::array<std::byte, 16>;

// The reference: bit i of an image is bit i % 8 of byte i / 8 (ETG.1000.5: least significant bit first).
bool bit(const Image& image, unsigned i) { return (std::to_integer<unsigned>(image[i / 8]) >> (i % 8) & 1u) != 0; }

void set_bit(Image& image, unsigned i, bool on) {
    const auto mask = std::byte{static_cast<unsigned char>(1u << (i % 8))};
    image[i / 8] = on ? image[i / 8] | mask : image[i / 8] & ~mask;
}

std::int64_t read_bit_by_bit(const Image& image, const Signal& s) {
    std::uint64_t value = 0;
    for (unsigned i = 0; i < s.bits; ++i) value |= std::uint64_t{bit(image, s.bit_offset + i)} << i;
    if (s.is_signed && bit(image, s.bit_offset + s.bits - 1))
        for (unsigned i = s.bits; i < 64; ++i) value |= std::uint64_t{1} << i;
    return static_cast<std::int64_t>(value);
}

Image write_bit_by_bit(Image image, const Signal& s, std::int64_t value) {
    for (unsigned i = 0; i < s.bits; ++i) set_bit(image, s.bit_offset + i, (static_cast<std::uint64_t>(value) >> i & 1u) != 0);
    return image;
}

template <class Check>
void for_every_place(Check check) {
    for (unsigned offset = 0; offset < 16; ++offset)
        for (unsigned bits = 1; bits <= 64; ++bits)
            for (const bool is_signed : {false, true}) check(Signal{offset, static_cast<std::uint8_t>(bits), is_signed});
}

Image random_image(std::mt19937_64& random) {
    Image image;
    for (auto& b : image) b = static_cast<std::byte>(random());
    return image;
}

TEST(ProcessImage, EveryOffsetAndLengthReadsWhatTheBitsSay) {
    std::mt19937_64 random{1};
    for_every_place([&](const Signal& s) {
        for (int i = 0; i < 8; ++i) {
            const Image image = random_image(random);
            ASSERT_EQ(read_signal(image, s), read_bit_by_bit(image, s)) << s.bit_offset << ' ' << int{s.bits} << ' ' << s.is_signed;
        }
    });
}

TEST(ProcessImage, EveryOffsetAndLengthWritesItsBitsAndNoOthers) {
    std::mt19937_64 random{2};
    for_every_place([&](const Signal& s) {
        for (int i = 0; i < 8; ++i) {
            Image image = random_image(random);
            const auto value = static_cast<std::int64_t>(random());
            const Image expected = write_bit_by_bit(image, s, value);
            write_signal(image, s, value);
            ASSERT_EQ(image, expected) << s.bit_offset << ' ' << int{s.bits};
        }
    });
}

// Under asan this also proves that no byte behind the last one of the signal is touched.
TEST(ProcessImage, ASignalMayEndWithTheImage) {
    for_every_place([](const Signal& s) {
        std::vector<std::byte> exact((s.bit_offset + s.bits + 7) / 8);
        write_signal(exact, s, 1);
        EXPECT_EQ(read_signal(exact, s), s.bits == 1 && s.is_signed ? -1 : 1);
    });
}

// SV33-E, PDO 1702h: 6060h (8 bits) stands between 607Fh and 60B8h, so what follows it is at odd bytes.
TEST(ProcessImage, SignedValueAtAnOddByteKeepsItsSign) {
    const Image image{std::byte{0xAA}, std::byte{0xFE}, std::byte{0xFF}, std::byte{0xFF}, std::byte{0xFF}, std::byte{0xAA}};

    EXPECT_EQ(read_signal(image, Signal{8, 32, true}), -2);
    EXPECT_EQ(read_signal(image, Signal{8, 32, false}), 0xFFFF'FFFE);
}

TEST(ProcessImage, ASignalThatIsNotMappedReadsZeroAndWritesNothing) {
    Image image;
    image.fill(std::byte{0xFF});
    const Image before = image;

    write_signal(image, Signal{}, 0);

    EXPECT_EQ(read_signal(image, Signal{}), 0);
    EXPECT_EQ(image, before);
    EXPECT_EQ(read_signal({}, Signal{}), 0);
}

}  // namespace
}  // namespace taktwerk
