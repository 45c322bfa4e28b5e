#include "apps/taktwerk.hpp"

int main(int argc, char** argv) { return taktwerk::apps::run(argc, argv); }
