"""Laboratory 7, for the numbers of 0."""

by_hand_ms = {"A": 1, "B": 4, "C": 10}
load_percent = 64.5


def response_us(task, higher):
    response, before = task["cost_us"] + task["blocking_us"], 0
    while response != before:
        before = response
        if response > task["deadline_us"]:
            return None
        response = task["cost_us"] + task["blocking_us"] + sum(-(-before // one["period_us"]) * one["cost_us"] for one in higher)
    return response


order = ["green", "white", "blue", "red", "black"]
