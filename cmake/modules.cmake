# spelunk_module(name SOURCES a.cpp ... LINK libs ...): the library of one module, whose LINK repeats
# the arrows of the layout. Sources are relative to src/<name>.
function(spelunk_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(spelunk_${name} ${arg_SOURCES})
  target_include_directories(spelunk_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include)
  target_include_directories(spelunk_${name} SYSTEM PUBLIC ${EIGEN3_INCLUDE_DIRS})
  target_link_libraries(spelunk_${name} PUBLIC ${arg_LINK} PRIVATE ${arg_PRIVATE_LINK})
  install(TARGETS spelunk_${name}
    ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
    LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

# spelunk_executable(name SOURCES ... LINK ...): a program that rosrun and roslaunch find.
function(spelunk_executable name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  install(TARGETS ${name} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

# spelunk_test(name SOURCES ... LINK ...): one GoogleTest program that ctest runs.
function(spelunk_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  catkin_add_gtest(${name} ${arg_SOURCES} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  target_compile_definitions(${name} PRIVATE SPELUNK_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} ${arg_LINK} gtest_main)
endfunction()
