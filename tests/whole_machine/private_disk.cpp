#include "tests/whole_machine/private_disk.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace taktwerk::whole {

namespace {

namespace fs = std::filesystem;
constexpr const char* size = "size=8m";

bool own_mounts() {
    const auto user = ::getuid();
    const auto group = ::getgid();
    if (::unshare(CLONE_NEWNS) != 0) {
        if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
        std::ofstream{"/proc/self/setgroups"} << "deny";
        std::ofstream{"/proc/self/uid_map"} << "0 " << user << " 1";
        std::ofstream{"/proc/self/gid_map"} << "0 " << group << " 1";
    }
    return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
}

}  // namespace

bool PrivateDisk::possible() {
    static const bool is = own_mounts();
    return is;
}

PrivateDisk::PrivateDisk() {
    auto pattern = (fs::temp_directory_path() / "taktwerk-whole-XXXXXX").string();
    place_ = ::mkdtemp(pattern.data());
    path_ = place_ / "disk";
    fs::create_directories(path_);
    mounted_ = possible() && ::mount("taktwerk", path_.c_str(), "tmpfs", 0, size) == 0;
}

PrivateDisk::~PrivateDisk() {
    mend();
    if (mounted_) (void)::umount2(path_.c_str(), MNT_DETACH);
    std::error_code ignored;
    fs::remove_all(place_, ignored);
}

void PrivateDisk::fill() {
    if (!mounted_) return;
    const int file = ::open((path_ / "somebody_elses").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    static const std::array<char, 65536> block{};
    ssize_t left = block.size();
    while (left > 0) {
        const auto written = ::write(file, block.data(), static_cast<std::size_t>(left));
        if (written <= 0) left /= 2;
    }
    ::close(file);
    full_ = true;
}

// The same disk once more over itself, read-only: as one that the kernel has taken writing from, also for who has files open there.
void PrivateDisk::take_nothing() {
    if (!mounted_ || covered_) return;
    if (::mount(path_.c_str(), path_.c_str(), nullptr, MS_BIND, nullptr) != 0) return;
    covered_ = true;
    (void)::mount(nullptr, path_.c_str(), nullptr, MS_REMOUNT | MS_BIND | MS_RDONLY, nullptr);
}

void PrivateDisk::take_away() {
    if (gone_) return;
    gone_ = true;
    if (mounted_) {  // an empty disk that takes nothing lies over it
        gone_ = ::mount("taktwerk", path_.c_str(), "tmpfs", MS_RDONLY, size) == 0;
        return;
    }
    fs::rename(path_, place_ / "away");
    std::ofstream{path_} << "no folder";
}

void PrivateDisk::flip_a_bit(const fs::path& name, std::mt19937& random) {
    std::fstream file(name, std::ios::in | std::ios::out | std::ios::binary);
    if (!file) return;
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.empty()) return;
    const auto place = random() % text.size();
    file.clear();
    file.seekp(static_cast<std::streamoff>(place));
    file.put(static_cast<char>(text[place] ^ (1 << random() % 8)));
}

void PrivateDisk::mend() {
    if (gone_ && mounted_) (void)::umount2(path_.c_str(), MNT_DETACH);
    if (gone_ && !mounted_) {
        fs::remove(path_);
        fs::rename(place_ / "away", path_);
    }
    if (covered_) (void)::umount2(path_.c_str(), MNT_DETACH);
    gone_ = covered_ = false;
    std::error_code ignored;
    if (full_) fs::remove(path_ / "somebody_elses", ignored);
    full_ = false;
}

}  // namespace taktwerk::whole
