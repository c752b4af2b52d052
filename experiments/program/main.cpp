#include "experiments/program/command_line.h"

int main(int argc, char** argv) { return pliant::run_command_line(argc, argv); }
