#include "common/stage/stage.hpp"
#include "postprocess/postprocess.hpp"

int main(int argc, char** argv) { return talus::run_stage(argc, argv, talus::postprocess::stage()); }
