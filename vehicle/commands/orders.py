"""`python -m vehicle orders`: orders of crankshaft or wheels at steady speeds, with their limits and modes."""

from vehicle.commands.command_line import command
from vehicle.commands.console import Console
from vehicle.commands.options import (
    command_parser,
    extra_output_options,
    message_options,
    setting_options,
    vehicle_options,
)
from vehicle.commands.parser import Parser
from vehicle.runs.report.order_study import OrderSettings, order_study


def parser() -> Parser:
    """Return the parser of the options."""
    parser = command_parser(
        "orders",
        "Compute amplitudes at orders of the crankshaft or the wheels at steady speeds; limits and Campbell map.",
    )
    vehicle_options(parser)
    setting_options(parser, OrderSettings, "rpm", "speed", "orders", "channel", "angle", "road", "duration", "engine")
    parser.add_argument("--json", action="store_true", help="print JSON")
    extra_output_options(parser, "orders.csv, orders.png, campbell.png and report.html")
    message_options(parser)
    return parser


def print_orders(settings: OrderSettings, console: Console) -> None:
    """Run the car at each speed, and print its orders."""
    study = order_study(settings)
    console.result(study.summary(), study)


main = command(parser, OrderSettings, print_orders)
