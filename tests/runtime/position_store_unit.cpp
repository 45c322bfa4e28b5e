// The store of positions on a real directory: two slots, torn and altered files, numbers that come back as they were.

#include "runtime/position_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path;
    Folder() {
        auto name = (fs::temp_directory_path() / "taktwerk_positions_XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
};

RetainedAxis axis(std::string name, double shift) {
    axes::Gearing gearing{.counts_per_revolution = 131072, .motor_revolutions = 7, .load_revolutions = 3, .feed = 0.1, .inverted = true};
    return {std::move(name), {.homed = true, .shift = shift, .counts = -4711, .at_rest = true}, gearing};
}
std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

TEST(PositionStore, GivesBackWhatWasSaved) {
    Folder folder;
    const double awkward = std::nextafter(-0.1, 1) * 1e7;
    {
        PositionStore store(folder.path / "state");  // it is made
        EXPECT_TRUE(store.load().axes.empty());
        ASSERT_TRUE(store.save(std::vector{axis("x", awkward), axis("y", 3e-300)}).ok());
    }
    PositionStore store(folder.path / "state");
    const auto loaded = store.load();
    EXPECT_FALSE(loaded.lost);
    EXPECT_TRUE(loaded.damage.empty());
    ASSERT_EQ(loaded.axes.size(), 2u);
    EXPECT_EQ(loaded.axes[0].name, "x");
    EXPECT_EQ(loaded.axes[0].position, axis("x", awkward).position);
    EXPECT_TRUE(axes::same_coordinates(loaded.axes[0].gearing, axis("x", 0).gearing));
    EXPECT_EQ(loaded.axes[1].position.shift, 3e-300);
}

TEST(PositionStore, WritesTheSlotsInTurnAndTheNewestCounts) {
    Folder folder;
    PositionStore store(folder.path);
    (void)store.load();
    for (int i = 1; i <= 5; ++i) {
        ASSERT_TRUE(store.save(std::vector{axis("x", i)}).ok());
        PositionStore other(folder.path);
        EXPECT_EQ(other.load().axes[0].position.shift, i);
    }
    EXPECT_NE(text_of(folder.path / "positions.0").find("number 5"), std::string::npos);
    EXPECT_NE(text_of(folder.path / "positions.1").find("number 4"), std::string::npos);
    // A new store goes on behind the newest, over the older slot.
    PositionStore next(folder.path);
    (void)next.load();
    ASSERT_TRUE(next.save(std::vector{axis("x", 6)}).ok());
    EXPECT_NE(text_of(folder.path / "positions.1").find("number 6"), std::string::npos);
}

// Whatever is cut off or altered in the newer slot, the older one is used.
TEST(PositionStore, TornOrAlteredSlotFallsBackToTheOther) {
    Folder folder;
    PositionStore store(folder.path);
    (void)store.load();
    ASSERT_TRUE(store.save(std::vector{axis("x", 1)}).ok());
    ASSERT_TRUE(store.save(std::vector{axis("x", 2)}).ok());
    const auto whole = text_of(folder.path / "positions.1");
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
        write(folder.path / "positions.1", whole.substr(0, cut));
        const auto loaded = PositionStore(folder.path).load();
        ASSERT_EQ(loaded.axes.size(), 1u) << cut;
        EXPECT_EQ(loaded.axes[0].position.shift, 1) << cut;
        EXPECT_EQ(loaded.damage.size(), 1u) << cut;
        EXPECT_FALSE(loaded.lost);
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
        auto altered = whole;
        altered[at] = static_cast<char>(altered[at] ^ 1);
        write(folder.path / "positions.1", altered);
        EXPECT_EQ(PositionStore(folder.path).load().axes.at(0).position.shift, 1) << at;
    }
}

TEST(PositionStore, BothSlotsBadIsALoss) {
    Folder folder;
    write(folder.path / "positions.0", "nonsense");
    write(folder.path / "positions.1", "");
    PositionStore store(folder.path);
    const auto loaded = store.load();
    EXPECT_TRUE(loaded.lost);
    EXPECT_TRUE(loaded.axes.empty());
    ASSERT_EQ(loaded.damage.size(), 2u);
    EXPECT_NE(loaded.damage[0].subject.find("positions.0"), std::string::npos);
    ASSERT_TRUE(store.save(std::vector{axis("x", 1)}).ok());
    EXPECT_FALSE(PositionStore(folder.path).load().lost);
}

TEST(PositionStore, WhereNothingCanBeWrittenItSaysSo) {
    Folder folder;
    write(folder.path / "a_file", "");
    PositionStore store(folder.path / "a_file" / "state");
    const auto saved = store.save(std::vector{axis("x", 1)});
    ASSERT_FALSE(saved.ok());
    EXPECT_EQ(saved.error().code, "positions.cannot_write");
    EXPECT_FALSE(saved.error().remedy.empty());
}

}  // namespace
}  // namespace taktwerk::runtime
