// The store of what is kept on a real directory: two slots, torn and altered files, numbers that come back as they were.

#include "runtime/retain/retain_store.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>

#include "core/crc32.hpp"

namespace taktwerk::runtime {
namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path;
    Folder() {
        auto name = (fs::temp_directory_path() / "taktwerk_retain_XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
};

RetainedAxis axis(std::string name, double shift) {
    axes::Gearing gearing{.counts_per_revolution = 131072, .motor_revolutions = 7, .load_revolutions = 3, .feed = 0.1, .inverted = true};
    return {std::move(name), {.homed = true, .shift = shift, .counts = -4711, .at_rest = true}, gearing};
}
/// The same reference, another place.
RetainedAxis at(std::string name, std::int64_t counts) {
    auto out = axis(std::move(name), 12.5);
    out.position.counts = counts;
    return out;
}
Kept keeping(std::vector<RetainedAxis> axes) {
    Kept kept;
    kept.axes = std::move(axes);
    return kept;
}
std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}
void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

TEST(RetainStore, GivesBackWhatWasSaved) {
    Folder folder;
    const double awkward = std::nextafter(-0.1, 1) * 1e7;
    {
        RetainStore store(folder.path / "state");  // it is made
        EXPECT_TRUE(store.load().kept.axes.empty());
        ASSERT_TRUE(store.save(keeping({axis("x", awkward), axis("y", 3e-300)})).ok());
    }
    RetainStore store(folder.path / "state");
    const auto loaded = store.load();
    EXPECT_FALSE(loaded.lost);
    EXPECT_TRUE(loaded.damage.empty());
    ASSERT_EQ(loaded.kept.axes.size(), 2u);
    EXPECT_EQ(loaded.kept.axes[0].name, "x");
    EXPECT_EQ(loaded.kept.axes[0].position, axis("x", awkward).position);
    EXPECT_TRUE(axes::same_coordinates(loaded.kept.axes[0].gearing, axis("x", 0).gearing));
    EXPECT_EQ(loaded.kept.axes[1].position.shift, 3e-300);
}

TEST(RetainStore, WritesTheSlotsInTurnAndTheNewestCounts) {
    Folder folder;
    RetainStore store(folder.path);
    (void)store.load();
    for (int i = 1; i <= 5; ++i) {
        ASSERT_TRUE(store.save(keeping({at("x", i)})).ok());
        RetainStore other(folder.path);
        EXPECT_EQ(other.load().kept.axes[0].position.counts, i);
    }
    EXPECT_NE(content(folder.path / "retain.0").find("number 5"), std::string::npos);
    EXPECT_NE(content(folder.path / "retain.1").find("number 4"), std::string::npos);
    // A new store goes on behind the newest, over the older slot.
    RetainStore next(folder.path);
    (void)next.load();
    ASSERT_TRUE(next.save(keeping({at("x", 6)})).ok());
    EXPECT_NE(content(folder.path / "retain.1").find("number 6"), std::string::npos);
}

// Whatever is cut off or altered in the newer slot, the older one is used.
TEST(RetainStore, TornOrAlteredSlotFallsBackToTheOther) {
    Folder folder;
    RetainStore store(folder.path);
    (void)store.load();
    ASSERT_TRUE(store.save(keeping({at("x", 1)})).ok());
    ASSERT_TRUE(store.save(keeping({at("x", 2)})).ok());
    const auto whole = content(folder.path / "retain.1");
    for (std::size_t cut = 0; cut < whole.size(); ++cut) {
        write(folder.path / "retain.1", whole.substr(0, cut));
        const auto loaded = RetainStore(folder.path).load();
        ASSERT_EQ(loaded.kept.axes.size(), 1u) << cut;
        EXPECT_EQ(loaded.kept.axes[0].position.counts, 1) << cut;
        EXPECT_EQ(loaded.damage.size(), 1u) << cut;
        EXPECT_FALSE(loaded.lost);
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
        auto altered = whole;
        altered[at] = static_cast<char>(altered[at] ^ 1);
        write(folder.path / "retain.1", altered);
        EXPECT_EQ(RetainStore(folder.path).load().kept.axes.at(0).position.counts, 1) << at;
    }
}

// Somebody copied the files back as another user. A link to itself stands for that here: root reads whatever is there.
TEST(RetainStore, AFileThatCannotBeReadIsLostUntilItCanAndIsNotWrittenOver) {
    Folder folder;
    for (const auto* name : {"retain.0", "retain.1"}) fs::create_symlink(name, folder.path / name);
    RetainStore store(folder.path);
    const auto loaded = store.load();
    EXPECT_TRUE(loaded.lost) << "something is there";
    ASSERT_EQ(loaded.damage.size(), 2u);
    EXPECT_EQ(loaded.damage[0].code, "retain.unreadable");

    for (int i = 1; i <= 2; ++i) ASSERT_TRUE(store.save(keeping({at("x", i)})).ok());
    EXPECT_EQ(RetainStore(folder.path).load().kept.axes.at(0).position.counts, 2);
    for (const auto* name : {"retain.0.unread", "retain.1.unread"}) EXPECT_TRUE(fs::is_symlink(folder.path / name)) << name;
}

// It happened before, and nobody has looked yet: what was kept then is not written over either.
TEST(RetainStore, WhatIsSetAsideDoesNotTakeThePlaceOfWhatWasSetAsideBefore) {
    Folder folder;
    write(folder.path / "retain.0.unread", "of the first time");
    fs::create_symlink("retain.0", folder.path / "retain.0");
    RetainStore store(folder.path);
    ASSERT_EQ(store.load().damage.size(), 1u);
    ASSERT_TRUE(store.save(keeping({at("x", 1)})).ok());
    EXPECT_TRUE(fs::is_regular_file(folder.path / "retain.0.unread"));
    EXPECT_EQ(fs::file_size(folder.path / "retain.0.unread"), std::string("of the first time").size());
    EXPECT_TRUE(fs::is_symlink(folder.path / "retain.0.unread.2"));
}

TEST(RetainStore, APipeInThePlaceOfAFileHoldsNobodyUp) {
    Folder folder;
    ASSERT_EQ(::mkfifo((folder.path / "retain.0").c_str(), 0600), 0);
    const auto loaded = RetainStore(folder.path).load();
    ASSERT_EQ(loaded.damage.size(), 1u);
    EXPECT_EQ(loaded.damage[0].code, "retain.unreadable");
}

// Who cannot open the lock cannot see whether it is held.
TEST(RetainStore, ALockThatCannotBeOpenedKeepsEverybodyOut) {
    Folder folder;
    fs::create_symlink("nowhere", folder.path / "retain.lock");
    RetainStore store(folder.path);
    const auto refused = store.lock();
    ASSERT_TRUE(refused.has_value());
    EXPECT_EQ(refused->code, "retain.lock");
    fs::remove(folder.path / "retain.lock");
    EXPECT_FALSE(store.lock().has_value());
}

TEST(RetainStore, WhatCouldNotBeReadAgainIsNotWritten) {
    Folder folder;
    RetainStore store(folder.path);
    (void)store.load();
    ASSERT_TRUE(store.save(keeping({at("x", 1)})).ok());
    const auto refused = store.save(keeping({at("x", 1), at("x", 2)}));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "retain.not_readable");
    RetainStore other(folder.path);
    const auto loaded = other.load();
    EXPECT_TRUE(loaded.damage.empty());
    EXPECT_EQ(loaded.kept.axes.at(0).position.counts, 1);
}

// A slot that somebody wrote by hand, with a check sum that fits.
std::string sealed(const std::string& axis_line) {
    const std::string text = "taktwerk retain 1\nnumber 3\n" + axis_line;
    char sum[20];
    std::snprintf(sum, sizeof sum, "crc %08x\n", crc32(std::as_bytes(std::span(text.data(), text.size()))));
    return text + sum;
}

TEST(RetainStore, WhatNoAxisCanHaveIsDamageWhateverTheCheckSum) {
    Folder folder;
    const auto loaded = [&](const std::string& line) {
        write(folder.path / "retain.0", sealed(line));
        return RetainStore(folder.path).load();
    };
    const std::string good = "axis x homed 1 shift 12.5 counts -4711 at_rest 1 gearing 10000 1 1 10 0\n";
    ASSERT_EQ(loaded(good).kept.axes.size(), 1u) << "the control";
    for (const std::string bad : {"axis x homed 1 shift nan counts 1 at_rest 1 gearing 10000 1 1 10 0\n",
                                  "axis x homed 1 shift inf counts 1 at_rest 1 gearing 10000 1 1 10 0\n",
                                  "axis x homed 1 shift -inf counts 1 at_rest 1 gearing 10000 1 1 10 0\n",
                                  "axis x homed 1 shift 1e300 counts 1 at_rest 1 gearing 10000 1 1 10 0\n",
                                  "axis x homed 1 shift 1 counts 9223372036854775807 at_rest 1 gearing 10000 1 1 10 0\n",
                                  "axis x homed 1 shift 1 counts -9223372036854775808 at_rest 1 gearing 10000 1 1 10 0\n",
                                  "axis x homed 1 shift 1 counts 1 at_rest 1 gearing 10000 1 1 nan 0\n",
                                  "axis x homed 1 shift 1 counts 1 at_rest 1 gearing 10000 1 1 0 0\n",
                                  "axis x homed 1 shift 1 counts 1 at_rest 1 gearing 10000 1 0 10 0\n",
                                  "axis x homed 1 shift 1 counts 1 at_rest 1 gearing -1 1 1 10 0\n"}) {
        const auto found = loaded(bad);
        EXPECT_TRUE(found.kept.axes.empty()) << bad;
        EXPECT_EQ(found.damage.size(), 1u) << bad;
    }
    EXPECT_TRUE(loaded(good + good).kept.axes.empty()) << "which of the two?";
}

// Whichever slot is lost afterwards, nothing names the old reference any more.
TEST(RetainStore, AChangedReferenceIsInBothSlots) {
    Folder folder;
    RetainStore store(folder.path);
    (void)store.load();
    ASSERT_TRUE(store.save(keeping({axis("x", 1), at("y", 5)})).ok());
    ASSERT_TRUE(store.save(keeping({axis("x", 1), at("y", 6)})).ok());
    ASSERT_TRUE(store.save(keeping({at("y", 6)})).ok());  // x has none for the moment
    for (const char* slot : {"retain.0", "retain.1"}) {
        EXPECT_EQ(content(folder.path / slot).find("axis x"), std::string::npos) << slot;
        EXPECT_NE(content(folder.path / slot).find("axis y"), std::string::npos) << slot;
    }
}

TEST(RetainStore, WhereNoNewSlotCanBeWrittenTheOldReferenceIsTakenBack) {
    Folder folder;
    RetainStore store(folder.path);
    (void)store.load();
    ASSERT_TRUE(store.save(keeping({axis("x", 1)})).ok());
    for (const char* beside : {"retain.0.new", "retain.1.new"}) fs::create_directory(folder.path / beside);  // takes no file
    const auto same = store.save(keeping({axis("x", 1)}));
    ASSERT_FALSE(same.ok());
    EXPECT_EQ(same.error().code, "retain.cannot_write");
    EXPECT_EQ(RetainStore(folder.path).load().kept.axes.size(), 1u) << "what is still so stays";

    const auto other = store.save(keeping({axis("x", 2)}));
    ASSERT_FALSE(other.ok());
    EXPECT_EQ(other.error().code, "retain.cannot_write");
    EXPECT_TRUE(RetainStore(folder.path).load().kept.axes.empty());
}

TEST(RetainStore, OneProcessAtATimeHasTheDirectory) {
    Folder folder;
    auto first = std::make_unique<RetainStore>(folder.path / "state");
    EXPECT_FALSE(first->lock());
    RetainStore second(folder.path / "state");
    const auto refused = second.lock();
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->code, "retain.in_use");
    EXPECT_NE(refused->what.find(std::to_string(::getpid())), std::string::npos) << refused->text();
    const auto mode = fs::status(folder.path / "state" / "retain.lock").permissions();
    EXPECT_EQ(mode & (fs::perms::group_all | fs::perms::others_all), fs::perms::none) << "who can open it can hold it";
    first.reset();
    EXPECT_FALSE(second.lock());
}

TEST(RetainStore, BothSlotsBadIsALoss) {
    Folder folder;
    write(folder.path / "retain.0", "nonsense");
    write(folder.path / "retain.1", "");
    RetainStore store(folder.path);
    const auto loaded = store.load();
    EXPECT_TRUE(loaded.lost);
    EXPECT_TRUE(loaded.kept.axes.empty());
    ASSERT_EQ(loaded.damage.size(), 2u);
    EXPECT_NE(loaded.damage[0].subject.find("retain.0"), std::string::npos);
    ASSERT_TRUE(store.save(keeping({axis("x", 1)})).ok());
    EXPECT_FALSE(RetainStore(folder.path).load().lost);
}

TEST(RetainStore, WhereNothingCanBeWrittenItSaysSo) {
    Folder folder;
    write(folder.path / "a_file", "");
    RetainStore store(folder.path / "a_file" / "state");
    const auto saved = store.save(keeping({axis("x", 1)}));
    ASSERT_FALSE(saved.ok());
    EXPECT_EQ(saved.error().code, "retain.cannot_write");
    EXPECT_FALSE(saved.error().remedy.empty());
}

// An update of the runtime loses no reference: what the one before wrote is read once, and gone when something newer stands there.
TEST(RetainStore, FilesOfAnOlderRuntimeAreReadAndReplaced) {
    Folder folder;
    std::string text = "taktwerk positions 1\nnumber 41\naxis x homed 1 shift 12.5 counts -4711 at_rest 1 gearing 131072 7 3 0.1 1\n";
    char sum[20];
    std::snprintf(sum, sizeof sum, "crc %08x\n", crc32(std::as_bytes(std::span(text.data(), text.size()))));
    write(folder.path / "positions.0", text + sum);
    {
        RetainStore store(folder.path);
        const auto loaded = store.load();
        ASSERT_EQ(loaded.kept.axes.size(), 1u);
        EXPECT_EQ(loaded.kept.axes[0].position, at("x", -4711).position);
        ASSERT_TRUE(store.save(keeping({at("x", -4700)})).ok());
    }
    EXPECT_FALSE(fs::exists(folder.path / "positions.0"));
    const auto again = RetainStore(folder.path).load();
    ASSERT_EQ(again.kept.axes.size(), 1u);
    EXPECT_EQ(again.kept.axes[0].position.counts, -4700);
    EXPECT_EQ(again.kept.number, 42u);
}

}  // namespace
}  // namespace taktwerk::runtime
