"""Order, readers and makers follow from the signatures; what is no graph is refused in a sentence."""

import pytest
from toy_graph import GRAPH, SQUARES, SUMMARY, Extra, Inputs, Never, Squares, after_stage, inputs, largest, never

from pipeline.graph import Graph, GraphError, Source, Stage, View, drawing, parameters, product, takes_workers


def test_a_signature_says_what_is_read_and_made():
    assert [(one.name, one.kind, one.optional) for one in parameters(SUMMARY.function)][-1] == ("extra", Extra, True)
    assert product(inputs) is Inputs and takes_workers(SQUARES.function) == "workers"
    assert product(never) is Never and takes_workers(SUMMARY.function) is None


def test_stages_run_after_those_they_read_from_through_views_too():
    assert [stage.name for stage in GRAPH.stages] == ["squares", "summary"]
    assert [stage.name for stage in GRAPH.before(SQUARES)] == ["squares"]
    assert GRAPH.parents(SUMMARY.function) == (SQUARES,)


@pytest.mark.parametrize("on_request", [True, False])
def test_what_runs_on_request_and_may_be_absent_is_not_asked_for_by_its_readers(on_request):
    def extra_stage(squares: Squares) -> Extra:
        return Extra(str(squares))

    graph = Graph((*GRAPH.nodes, Stage("extra", extra_stage, "", on_request=on_request)))
    before = [stage.name for stage in graph.before(graph.stage("summary"))]
    assert before == ["squares", "summary"] if on_request else ["squares", "extra", "summary"]


def test_two_makers_of_one_type_are_refused():
    with pytest.raises(GraphError, match="Inputs is made by inputs and by inputs; give it one maker"):
        Graph((Source(inputs), Source(inputs)))


def test_a_type_that_nothing_makes_is_refused_unless_it_may_be_absent():
    with pytest.raises(GraphError, match="largest reads Squares, which nothing makes"):
        Graph((Source(inputs), View(largest), SUMMARY))


def test_a_circle_is_refused():
    with pytest.raises(GraphError, match="go round in a circle"):
        Graph((*GRAPH.nodes, Stage("after", after_stage, "")))


def test_an_annotation_that_is_no_class_is_refused():
    def loose(inputs):
        return inputs

    with pytest.raises(GraphError, match="does not say what inputs is"):
        parameters(loose)


def test_the_drawing_has_an_arrow_for_each_artefact_that_is_read():
    assert "    squares -- Squares --> summary" in drawing(GRAPH)
