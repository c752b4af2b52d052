# Does what docs/adding-a-component.md tells its reader to do, to copies of the rooms `energies`,
# `framework/pose`, `experiments/datasets` and `experiments/report`, and runs the tests there. Variables: SOURCE
# (the project), WORK (a folder to work in), ROOMS (the exported libraries) and CONFIGURE (arguments for
# configuring, separated by |).
cmake_minimum_required(VERSION 3.25)
file(READ ${SOURCE}/docs/adding-a-component.md DOCUMENT)

# The code block that follows the line "<TITLE>:".
function(code_block TITLE LANGUAGE OUTPUT)
  set(OPENING "${TITLE}:\n\n```${LANGUAGE}\n")
  string(FIND "${DOCUMENT}" "${OPENING}" BEGIN)
  if(BEGIN LESS 0)
    message(FATAL_ERROR "the document has no block of ${LANGUAGE} after '${TITLE}:'")
  endif()
  string(LENGTH "${OPENING}" LENGTH)
  math(EXPR BEGIN "${BEGIN} + ${LENGTH}")
  string(SUBSTRING "${DOCUMENT}" ${BEGIN} -1 REST)
  string(FIND "${REST}" "```" END)
  string(SUBSTRING "${REST}" 0 ${END} BLOCK)
  set(${OUTPUT} "${BLOCK}" PARENT_SCOPE)
endfunction()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The code block after TITLE is the file PATH of the tree. The example of the tests must be the same.
function(write_example PATH EXAMPLE_FILE)
  code_block("`${PATH}`" cpp TEXT)
  file(WRITE ${TREE}/${PATH} "${TEXT}")
  file(READ ${SOURCE}/tests/adding_a_component/${EXAMPLE_FILE} EXAMPLE)
  if(NOT TEXT STREQUAL EXAMPLE)
    message(FATAL_ERROR "the document and tests/adding_a_component/${EXAMPLE_FILE} differ")
  endif()
endfunction()

# Puts the code block after TITLE behind the text ANCHOR of the file PATH of the tree.
function(add_to PATH ANCHOR TITLE LANGUAGE)
  code_block("${TITLE}" ${LANGUAGE} TEXT)
  string(STRIP "${TEXT}" TEXT)
  file(READ ${TREE}/${PATH} BEFORE)
  string(REPLACE "${ANCHOR}" "${ANCHOR}${SEPARATOR}${TEXT}" AFTER "${BEFORE}")
  if(AFTER STREQUAL BEFORE)
    message(FATAL_ERROR "${PATH} has no '${ANCHOR}'")
  endif()
  file(WRITE ${TREE}/${PATH} "${AFTER}")
endfunction()

# Adds the component STEM to the room ROOM, whose list is the function FUNCTION of LIST.cpp. What the line TITLE
# announces is an experiment that names it; it becomes the file EXPERIMENT of WORK.
function(add_to_room ROOM STEM LIST FUNCTION TITLE EXPERIMENT)
  write_example(${ROOM}/${STEM}.h ${STEM}/${STEM}.h)
  write_example(${ROOM}/${STEM}.cpp ${STEM}/${STEM}.cpp)
  set(SEPARATOR " ")
  add_to(${ROOM}/CMakeLists.txt "SOURCES" "In `${ROOM}/CMakeLists.txt`, behind `SOURCES`" cmake)
  set(SEPARATOR "\n")
  add_to(${ROOM}/${LIST}.cpp "#include \"${ROOM}/${LIST}.h\""
    "In `${ROOM}/${LIST}.cpp`, with the other includes" cpp)
  add_to(${ROOM}/${LIST}.cpp "void ${FUNCTION}(Registry& registry) {"
    "In `${ROOM}/${LIST}.cpp`, in `${FUNCTION}`" cpp)
  code_block("${TITLE}" yaml TEXT)
  file(WRITE ${WORK}/${EXPERIMENT} "${TEXT}")
endfunction()

set(TREE ${WORK}/tree)
file(REMOVE_RECURSE ${TREE})
file(COPY ${SOURCE}/energies ${SOURCE}/cmake DESTINATION ${TREE})
file(COPY ${SOURCE}/framework/pose DESTINATION ${TREE}/framework)
file(COPY ${SOURCE}/experiments/datasets ${SOURCE}/experiments/report DESTINATION ${TREE}/experiments)
file(COPY ${SOURCE}/tests/adding_a_component/project/CMakeLists.txt DESTINATION ${TREE})

write_example(energies/stillness/equation.h stillness/equation.h)
write_example(energies/stillness/energy.cpp stillness/energy.cpp)
set(SEPARATOR " ")
add_to(energies/energies.h "#define PLIANT_ENERGIES(ENERGY)"
  "In `energies/energies.h`, in the list `PLIANT_ENERGIES`" cpp)
code_block("In an experiment file" yaml EXPERIMENT)
file(WRITE ${WORK}/experiment.yaml "${EXPERIMENT}")

add_to_room(experiments/datasets approaching_wall datasets register_datasets
  "An experiment file names it" frames.yaml)
add_to_room(framework/pose align_centroids alignments register_alignments
  "As the alignment of an experiment" pose.yaml)

write_example(experiments/report/csv.cpp csv/csv.cpp)
set(SEPARATOR " ")
add_to(experiments/report/reports.h "#define PLIANT_REPORTS(REPORT)"
  "In `experiments/report/reports.h`, in the list `PLIANT_REPORTS`" cpp)
code_block("Among the reports of an experiment" yaml EXPERIMENT)
file(WRITE ${WORK}/reports.yaml "${EXPERIMENT}")

string(REPLACE "|" ";" CONFIGURE "${CONFIGURE}")
run(${CMAKE_COMMAND} -S ${TREE} -B ${WORK}/build ${CONFIGURE} -DPLIANT_ROOMS=${ROOMS} -DPLIANT_SOURCE=${SOURCE})
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
run(${CMAKE_COMMAND} -E env PLIANT_EXAMPLE=${WORK}/experiment.yaml ${WORK}/build/follow)
run(${CMAKE_COMMAND} -E env PLIANT_FRAMES_EXAMPLE=${WORK}/frames.yaml ${WORK}/build/follow_frames)
run(${CMAKE_COMMAND} -E env PLIANT_REPORT_EXAMPLE=${WORK}/reports.yaml ${WORK}/build/follow_report)
run(${CMAKE_COMMAND} -E env PLIANT_POSE_EXAMPLE=${WORK}/pose.yaml ${WORK}/build/follow_pose)
