// One kind of motion, over and over, for a tool that counts instructions (README.md): only what runs inside counted() is to be counted.
//
//     motion_cost MOTION [AXES]      says how many axes times cycles counted() went through; 16 axes unless told

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/bench/moving_axes.hpp"

/// The tool knows it by this name.
extern "C" __attribute__((noinline)) void counted(void (*cycle)(void*), void* what, int cycles) {
    for (int i = 0; i < cycles; ++i) cycle(what);
}

namespace {

using namespace taktwerk;

constexpr int cycles = 1000;

void count(void (*cycle)(void*), void* what, std::size_t axes) {
    counted(cycle, what, cycles);
    std::printf("axes and cycles: %zu\n", axes * cycles);
}

void to_and_fro(std::size_t axes) {
    struct All {
        std::size_t count;
        bench::Shuttles shuttles{count};
    } all{axes};
    count([](void* it) { static_cast<All*>(it)->shuttles.cycle(static_cast<All*>(it)->count); }, &all, axes);
}

/// The first axis leads the others.
void followers(std::size_t axes, void (*begin)(bench::Followers&)) {
    bench::Followers all{axes - 1};
    begin(all);
    count([](void* it) { static_cast<bench::Followers*>(it)->cycle(); }, &all, axes);
}

bool move(std::string_view motion, std::size_t axes) {
    if (motion == "to_and_fro") to_and_fro(axes);
    else if (motion == "standing") followers(axes, [](bench::Followers&) {});
    else if (motion == "at_velocity") followers(axes, [](bench::Followers& f) { f.run_all(); });
    else if (motion == "geared") followers(axes, [](bench::Followers& f) { f.run_master(), f.gear(); });
    else if (motion == "on_a_cam") followers(axes, [](bench::Followers& f) { f.run_master(), f.cam(); });
    else return false;
    return true;
}

}  // namespace

int main(int count, char** words) {
    const long axes = count > 2 ? std::strtol(words[2], nullptr, 10) : 16;
    if (count > 1 && axes > 1 && move(words[1], static_cast<std::size_t>(axes))) return 0;
    std::fprintf(stderr, "motion_cost to_and_fro|standing|at_velocity|geared|on_a_cam [AXES]\n");
    return 2;
}
