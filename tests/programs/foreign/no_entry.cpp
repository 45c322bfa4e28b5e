// Some other shared object.
extern "C" __attribute__((visibility("default"))) int answer() { return 42; }
