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
  set_target_properties(spelunk_${name} PROPERTIES INSTALL_RPATH "$ORIGIN")
endfunction()

# spelunk_executable(name SOURCES ... LINK ...): a program that rosrun and roslaunch find.
function(spelunk_executable name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION})
  set_target_properties(${name} PROPERTIES INSTALL_RPATH "$ORIGIN/..")  # the libraries, installed
  install(TARGETS ${name} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
  spelunk_show_to_rosrun(${name})
endfunction()

# rosrun looks through the package but leaves out all below its folder build/. Where the devel space
# lies there, a link in bin/ shows the program to it. A script of the same name is what users type.
function(spelunk_show_to_rosrun name)
  file(RELATIVE_PATH devel ${PROJECT_SOURCE_DIR} ${CATKIN_DEVEL_PREFIX})
  if(NOT devel MATCHES "^build/" OR EXISTS ${PROJECT_SOURCE_DIR}/scripts/${name})
    return()
  endif()
  file(MAKE_DIRECTORY ${PROJECT_SOURCE_DIR}/bin)
  file(CREATE_LINK ../${devel}/${CATKIN_PACKAGE_BIN_DESTINATION}/${name}
    ${PROJECT_SOURCE_DIR}/bin/${name} SYMBOLIC)
endfunction()

# spelunk_test(name SOURCES ... LINK ...): one GoogleTest program that ctest runs.
function(spelunk_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  catkin_add_gtest(${name} ${arg_SOURCES} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  target_compile_definitions(${name} PRIVATE SPELUNK_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} ${arg_LINK} gtest_main)
endfunction()
