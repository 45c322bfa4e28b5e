#include "core/recording_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string_view>

#include "core/bytes.hpp"
#include "core/crc32.hpp"

namespace taktwerk {
namespace {

using testing::HasSubstr;

class RecordingFile : public testing::Test {
protected:
    RecordingFile() {
        recorder.append(0, Instant{Duration{1}}, bytes("first"));
        recorder.append(1, Instant{Duration{-2}}, {});
        recorder.append(0, Instant{Duration{3}}, bytes("third"));
    }
    ~RecordingFile() override { std::filesystem::remove(path); }

    static std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span{text.data(), text.size()}); }

    std::vector<std::byte> file() const {
        std::ifstream in{path, std::ios::binary};
        const std::string all{std::istreambuf_iterator<char>{in}, {}};
        return {bytes(all).begin(), bytes(all).end()};
    }

    std::string path = testing::TempDir() + "taktwerk_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".rec";
    RecordingInfo info{{"inputs", "commands"}, {{"config", "sha256:00"}, {"binary", "0.1.0"}}};
    Recorder recorder{1024, Recorder::Policy::drop_newest};
};

TEST(Crc32, OfTheCheckTextIsTheCataloguedValue) {
    constexpr std::string_view check = "123456789";  // catalogue of parametrised CRC algorithms: CRC-32/ISO-HDLC, check CBF43926h
    const auto all = std::as_bytes(std::span{check.data(), check.size()});
    EXPECT_EQ(crc32(all), 0xCBF43926u);
    EXPECT_EQ(crc32(all.subspan(4), crc32(all.first(4))), 0xCBF43926u);
    EXPECT_EQ(crc32({}), 0u);
}

TEST_F(RecordingFile, WhatWasSavedIsLoaded) {
    ASSERT_TRUE(save_recording(path, info, recorder).ok());

    const auto loaded = load_recording(path);

    ASSERT_TRUE(loaded.ok()) << loaded.error().text();
    EXPECT_EQ(loaded->info, info);
    EXPECT_TRUE(loaded->complete);
    EXPECT_EQ(loaded->lost, 0u);
    ASSERT_EQ(loaded->size(), 3u);
    EXPECT_EQ(loaded->record(1).channel, 1);
    EXPECT_EQ(loaded->record(1).time, Instant{Duration{-2}});
    EXPECT_TRUE(loaded->record(1).bytes.empty());
    EXPECT_THAT(loaded->record(2).bytes, testing::ElementsAreArray(bytes("third")));
}

TEST_F(RecordingFile, LossesAreInTheFile) {
    Recorder small{64, Recorder::Policy::overwrite_oldest};
    for (int i = 0; i < 7; ++i) small.append(0, Instant{Duration{i}}, bytes("x"));
    ASSERT_TRUE(save_recording(path, info, small).ok());
    EXPECT_EQ(load_recording(path)->lost, 5u);  // two of 32 bytes are left
}

TEST_F(RecordingFile, CutOffAnywhereItLoadsUpToTheLastWholeRecordAndSaysIncomplete) {
    ASSERT_TRUE(save_recording(path, info, recorder).ok());
    const auto whole = file();

    std::size_t last = 3;
    for (std::size_t length = whole.size() - 1; length > 0; --length) {
        const auto loaded = parse_recording({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}, "cut.rec");
        if (!loaded.ok()) continue;  // within the head
        ASSERT_FALSE(loaded->complete);
        ASSERT_LE(loaded->size(), last);
        last = loaded->size();
    }
    EXPECT_EQ(last, 0u);
}

TEST_F(RecordingFile, AnyFlippedBitIsNoticed) {
    ASSERT_TRUE(save_recording(path, info, recorder).ok());
    const auto whole = file();
    for (std::size_t i = 0; i < whole.size() * 8; ++i) {
        auto damaged = whole;
        damaged[i / 8] ^= std::byte{static_cast<unsigned char>(1u << (i % 8))};
        const auto loaded = parse_recording(damaged, "damaged.rec");
        // A damaged length can look like a file that was cut off: then it says incomplete.
        ASSERT_TRUE(!loaded.ok() || !loaded->complete) << "bit " << i;
    }
}

TEST_F(RecordingFile, ErrorsNameTheFileAndWhatIsWrong) {
    EXPECT_EQ(parse_recording({}, "empty.rec").error().code, "recording.not_a_recording");
    EXPECT_THAT(load_recording("/nonexistent/a.rec").error().text(), HasSubstr("/nonexistent/a.rec"));
    EXPECT_EQ(save_recording("/nonexistent/a.rec", info, recorder).error().code, "recording.write");

    ASSERT_TRUE(save_recording(path, info, recorder).ok());
    auto newer = file();
    store_le(std::span{newer}, 6, std::uint16_t{2});
    EXPECT_EQ(parse_recording(newer, "newer.rec").error().code, "recording.version");

    auto damaged = file();
    damaged[damaged.size() - 29] ^= std::byte{1};  // the last byte of "third": end mark is 28 bytes
    EXPECT_EQ(parse_recording(damaged, "damaged.rec").error().code, "recording.corrupt");
}

TEST_F(RecordingFile, AFullDiskIsAnError) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    EXPECT_EQ(save_recording("/dev/full", info, recorder).error().code, "recording.write");
}

}  // namespace
}  // namespace taktwerk
