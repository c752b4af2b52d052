#include "experiments/program/command_line.h"
#include "experiments/program/interruption.h"
#include "experiments/program/output.h"

int main(int argc, char** argv) {
  pliant::secure_standard_streams();
  pliant::answer_interruptions();
  return pliant::run_command_line(argc, argv);
}
